#include <fmt/format.h>

#include <filesystem>

#include "ui/model/explorer.hpp"
#include "ui/model/task_plans.hpp"

namespace sweepscope::ui {
namespace {

std::optional<std::string> named(const Call& call, std::size_t i) {
  const std::string text = call.text(i);
  return text.empty() ? std::nullopt : std::optional(text);
}

/// The choices after a command of the page.
ReadingChoices changed(ReadingChoices choices, const Call& call) {
  const std::string& name = call.command->name;
  if (name == "choose-laser") choices.streams.laser = named(call, 0);
  if (name == "choose-motor") {
    choices.streams.joint = named(call, 0);
    choices.streams.motor = named(call, 1);
  }
  if (name == "choose-stamps") {
    const std::string which = call.text(0);
    choices.stamps = which == "header"    ? std::optional(StampSource::kHeader)
                     : which == "receive" ? std::optional(StampSource::kReceive)
                                          : std::nullopt;
  }
  if (name == "choose-rig") choices.rig_file = call.text(0);
  if (name == "choose-poses") choices.poses = call.text(0);
  if (name == "choose-part") {
    const TimeWindow window{call.number(0), call.number(1)};
    choices.window = window.to_s > window.from_s ? std::optional(window) : std::nullopt;
  }
  return choices;
}

std::string in_words(const std::vector<std::string>& sentences) {
  std::string words;
  for (const std::string& sentence : sentences) words += (words.empty() ? "" : "\n") + sentence;
  return words;
}

/// Whether a file has to be looked at again.
bool reads_otherwise(const ReadingChoices& a, const ReadingChoices& b) {
  return a.streams != b.streams || a.rig_file != b.rig_file || a.stamps != b.stamps;
}

}  // namespace

std::vector<std::string> problems_of(const Explorer::Choosing& choosing) {
  std::vector<std::string> all;
  if (choosing.survey && !choosing.survey->streams.complete()) {
    for (const std::string& missing :
         {choosing.survey->streams.laser_problem, choosing.survey->streams.joint_problem})
      if (!missing.empty()) all.push_back(missing);
    return all;
  }
  if (!choosing.problem.empty())
    all.push_back(choosing.problem);
  else if (choosing.survey && !choosing.survey->problem.empty())
    all.push_back(choosing.survey->problem);
  return all;
}

Result<void> Explorer::start_choosing(const std::string& file) {
  ReadingChoices choices = options_.reading;
  if (!file.empty())
    choices.file = file;
  else if (loaded_ && !loaded_->choices.file.empty())
    choices = loaded_->choices;
  else
    return not_now("There is no recording to open with other choices: name its file.");
  std::error_code failed;
  if (auto inside = check_recording_roots(choices); !inside) return inside;
  if (!std::filesystem::exists(choices.file, failed))
    return unreadable(fmt::format("{}: there is no such file or folder", choices.file));
  message_.reset();
  choosing_ = Choosing{choices, std::nullopt, ""};
  start_survey();
  return {};
}

Result<void> Explorer::choose(const Call& call) {
  if (!choosing_) return not_now("Choose a recording first, with \"choose FILE\".");
  const ReadingChoices next = changed(choosing_->choices, call);
  if (call.command->name == "choose-part" && call.number(1) <= call.number(0) && call.number(1) != 0)
    return not_now("The time range must end after it begins.");
  if (auto inside = check_recording_roots(next); !inside) return inside;
  const bool again = reads_otherwise(next, choosing_->choices);
  if (next != choosing_->choices) choosing_->problem.clear();
  choosing_->choices = next;
  if (again) start_survey();
  return {};
}

Result<void> Explorer::open_chosen() {
  if (!choosing_) return not_now("There is no recording to open: choose one first.");
  load(ReadingChoices(choosing_->choices));
  return {};
}

void Explorer::start_survey() {
  background_.cancel(kSurvey);
  background_.start(
      "survey", kSurvey, "Looking at " + choosing_->choices.file,
      [this, choices = choosing_->choices](const Job& job) -> Background::Finish {
        auto found = survey_file(choices, job);
        if (job.cancelled()) return {};
        if (found) return [this, survey = std::move(*found)] { take(survey); };
        return [this, why = found.error()] {
          choosing_.reset();
          say(Message::Kind::kError, why.message);
        };
      },
      steps_of_surveying());
}

void Explorer::take(ReadingSurvey survey) {
  if (choosing_) choosing_->survey = std::move(survey);
}

void Explorer::stop_choosing() {
  background_.cancel(kSurvey);
  choosing_.reset();
}

std::optional<std::string> Explorer::observe_choices(std::string_view name) const {
  if (name == "page") return choosing_ ? "choices" : loaded_ ? "maps" : is_loading() ? "loading" : "start";
  if (!name.starts_with("chosen-")) return std::nullopt;
  const ReadingSurvey* survey = choosing_ && choosing_->survey ? &*choosing_->survey : nullptr;
  const RecordingSurvey streams = survey != nullptr ? survey->streams : RecordingSurvey();
  if (name == "chosen-laser") return streams.laser ? streams.lasers[*streams.laser].topic : "";
  if (name == "chosen-motor") return streams.joint ? streams.joints[*streams.joint].joint : "";
  if (name == "chosen-problem") return choosing_ ? in_words(problems_of(*choosing_)) : "";
  if (name == "chosen-parts") return std::to_string(survey != nullptr ? survey->motion.size() : 0);
  return std::nullopt;
}

}  // namespace sweepscope::ui
