#include "ui/explorer/choices_page.hpp"

#include <filesystem>

#include "ui/jobs/task_plans.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kSurvey = "survey";

/// Whether a file has to be looked at again.
bool reads_otherwise(const ReadingChoices& a, const ReadingChoices& b) {
  return a.streams != b.streams || a.rig_file != b.rig_file || a.stamps != b.stamps;
}

/// A folder's path may end with a slash.
std::filesystem::path plain(const std::string& file) {
  const auto path = std::filesystem::path(file).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

std::vector<std::string> problems_of(const ChoicesPage::Choosing& choosing) {
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

bool ChoicesPage::is_surveying() const {
  return background_.has(kSurvey);
}

void ChoicesPage::show(const ReadingChoices& choices) {
  choosing_ = Choosing{choices, std::nullopt, ""};
  forget();
  start_survey();
}

void ChoicesPage::show(const ReadingChoices& choices, ReadingSurvey survey, const std::string& problem) {
  choosing_ = Choosing{choices, std::move(survey), problem};
  forget();
}

void ChoicesPage::choose(const ReadingChoices& choices) {
  const bool again = reads_otherwise(choices, choosing_->choices);
  if (choices != choosing_->choices) choosing_->problem.clear();
  choosing_->choices = choices;
  if (again) start_survey();
}

void ChoicesPage::close() {
  background_.cancel(kSurvey);
  choosing_.reset();
}

const ReadingChoices* ChoicesPage::left(const std::string& file) const {
  return left_ && plain(left_->file) == plain(file) ? &*left_ : nullptr;
}

void ChoicesPage::leave() {
  if (!choosing_) return;
  auto choices = choosing_->choices;
  close();
  left_ = std::move(choices);
}

void ChoicesPage::start_survey() {
  background_.cancel(kSurvey);
  background_.start(
      kSurvey, kSurvey, "Looking at " + choosing_->choices.file,
      [this, choices = choosing_->choices](const Job& job) -> Background::Finish {
        auto found = survey_file(choices, job);
        if (job.cancelled()) return {};
        return [this, found = std::move(found)] {
          if (!found) {
            choosing_.reset();
            messages_.error(found.error());
          } else if (choosing_) {
            choosing_->survey = *found;
          }
        };
      },
      steps_of_surveying());
}

}  // namespace sweepscope::ui
