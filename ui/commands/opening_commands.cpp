#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/io/atomic_file.hpp"
#include "core/results/estimate_json.hpp"
#include "core/simulation/scenes/scene.hpp"
#include "ui/commands/commands.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/explorer/hints.hpp"
#include "ui/state/session.hpp"

namespace sweepscope::ui {
namespace {

/// A path in a session is that of the working folder, or lies beside the session.
std::string found_beside(const std::string& path, const std::filesystem::path& session,
                         const FileRoots& roots) {
  std::error_code ignored;
  if (path.empty() || (roots.can_read(path) && std::filesystem::exists(path, ignored))) return path;
  const std::filesystem::path beside = session.parent_path() / path;
  return std::filesystem::exists(beside, ignored) ? beside.string() : path;
}

/// How a session's recording is read: what the program was started with goes before what the session says.
ReadingChoices reading_of(const Session& session, const Call& open, const std::filesystem::path& path,
                          const Explorer::Options& options) {
  ReadingChoices choices = session.reading;
  choices.file = found_beside(open.text(0), path, options.roots);
  choices.poses = found_beside(open.text(1), path, options.roots);
  choices.rig_file = found_beside(choices.rig_file, path, options.roots);
  return merged(choices, options.reading);
}

Result<void> open_estimate(Explorer& explorer, const std::string& text, const std::string& path) {
  if (explorer.loaded() == nullptr) return not_now(path + " is an estimate: open its recording first.");
  return parse_estimate_json(text, path).map([&](Estimate&& estimate) {
    explorer.estimating.set(std::move(estimate));
  });
}

double seconds_of(const Call& sample) {
  return sample.values.size() > 1 ? sample.number(1) : 0;
}

Result<void> open_session(Explorer& explorer, const std::string& text, const std::string& path) {
  auto session = parse_session(text, path);
  if (!session) return tl::unexpected(session.error());
  if (session->source.empty()) {
    explorer.change(session->settings);
    return {};
  }
  const auto call = parse_call(session->source);
  const std::string name = call ? call->command->name : "";
  Restored restored{session->settings, session->estimate};
  if (name == "open" && !call->text(0).ends_with(".json"))
    explorer.load(reading_of(*session, *call, path, explorer.options()), std::move(restored));
  else if (name == "sample")
    explorer.load_sample(call->text(0), seconds_of(*call), std::move(restored));
  else
    return unreadable(fmt::format("{}: source: \"{}\" does not open a recording", path, session->source));
  explorer.files.set_session(path);
  return {};
}

Result<void> open_json(Explorer& explorer, const std::string& path) {
  explorer.files.add_input(path);
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  const bool is_estimate =
      json.is_object() && json.value("schema", nlohmann::json()) == "sweepscope.estimate/1";
  return is_estimate ? open_estimate(explorer, *text, path) : open_session(explorer, *text, path);
}

void open(Explorer& explorer, const Call& call) {
  const std::string path = call.text(0);
  if (path.ends_with(".json")) return explorer.messages.show_failure(open_json(explorer, path));
  ReadingChoices choices = explorer.options().reading;
  choices.file = path;
  if (!call.text(1).empty()) choices.poses = call.text(1);
  explorer.load(choices);
}

Result<void> open_page(Explorer& explorer, const Call& call) {
  ReadingChoices choices = explorer.options().reading;
  const Loaded* loaded = explorer.loaded();
  if (!call.text(0).empty())
    choices.file = call.text(0);
  else if (loaded != nullptr && !loaded->choices.file.empty())
    choices = loaded->choices;
  else
    return not_now("There is no recording to open with other choices: name its file.");
  if (const ReadingChoices* left = explorer.page.left(choices.file)) choices = *left;
  if (auto inside = explorer.files.check_reading(choices); !inside) return inside;
  std::error_code failed;
  if (!std::filesystem::exists(choices.file, failed))
    return unreadable(fmt::format("{}: there is no such file or folder", choices.file));
  explorer.messages.dismiss();
  explorer.page.show(choices);
  return {};
}

/// The recording that is open, with one choice changed.
Result<void> reopen(Explorer& explorer, const Call& call) {
  const Loaded* loaded = explorer.loaded();
  if (loaded == nullptr || loaded->choices.file.empty())
    return not_now("Only a recording from a file can be opened again otherwise.");
  ReadingChoices choices = loaded->choices;
  const std::string how = call.text(0);
  if (how == "receive-stamps") choices.stamps = StampSource::kReceive;
  if (how == "header-stamps") choices.stamps = StampSource::kHeader;
  if (how == "without-rig-file") choices.rig_file.clear();
  if (how == "whole") choices.window.reset();
  if (how == "stationary-part") {
    const auto part = stationary_part(explorer);
    if (!part) return not_now("There is no part in which the rig was stationary for long enough.");
    choices.window = TimeWindow{part->begin_s, part->end_s};
  }
  explorer.load(choices);
  return {};
}

std::optional<std::string> named(const Call& call, std::size_t i) {
  const std::string text = call.text(i);
  return text.empty() ? std::nullopt : std::optional(text);
}

Result<void> choose_part(ReadingChoices& choices, const Call& call) {
  const TimeWindow window{call.number(0), call.number(1)};
  if (window.to_s <= window.from_s && window.to_s != 0)
    return not_now("The time range must end after it begins.");
  choices.window = window.to_s > window.from_s ? std::optional(window) : std::nullopt;
  return {};
}

/// Sets one of the choices on the page; `set` takes them and the call.
template <typename Set>
Command choosing(CommandWords words, std::vector<Parameter> parameters, Set set) {
  return action(std::move(words), std::move(parameters),
                [set](Explorer& explorer, const Call& call) -> Result<void> {
                  const auto* page = explorer.page.choosing();
                  if (page == nullptr) return not_now("Choose a recording first, with \"choose FILE\".");
                  ReadingChoices next = page->choices;
                  if (auto valid = done(set, next, call); !valid) return valid;
                  return explorer.files.check_reading(next).map([&] { explorer.page.choose(next); });
                });
}

Result<void> open_chosen(Explorer& explorer, const Call&) {
  if (explorer.page.choosing() == nullptr) return not_now("There is no recording to open: choose one first.");
  explorer.load(explorer.page.choosing()->choices);
  return {};
}

Result<void> add_recording(Explorer& explorer, const Call& call) {
  ReadingChoices choices = explorer.options().reading;
  choices.file = call.text(0);
  if (auto inside = explorer.files.check_reading(choices); !inside) return inside;
  return explorer.rig.add(explorer.loaded(), choices.file).map([&] { explorer.files.add_inputs(choices); });
}

Result<void> estimate_together(Explorer& explorer, const Call& call) {
  return explorer.rig.estimate(explorer.recording.loaded(),
                               estimate_asked_for(explorer.settings(), explorer.options().assume),
                               call.text(0) == "each");
}

Parameter file_read(std::string name) {
  return {.name = std::move(name), .kind = Kind::kText, .file = FileUse::kRead};
}

std::vector<Command> commands_of_page() {
  return {
      action({"choose", "Open with other choices",
              "Shows a page with everything that decides how a recording is read: its topics, the "
              "motor's joint, stamps, a rig file, a part in time, and a known trajectory. Without a "
              "file: of the recording that is open."},
             {optional_of(file_read("FILE"))}, open_page),
      choosing({"choose-laser", "Laser", "On the page: the topic of the scans. None: detected."},
               {optional_of(text_of("TOPIC"))},
               [](ReadingChoices& choices, const Call& call) { choices.streams.laser = named(call, 0); }),
      choosing({"choose-motor", "Motor",
                "On the page: the joint that turns the laser, and its topic if several have a joint "
                "of that name. None: detected."},
               {optional_of(text_of("JOINT")), optional_of(text_of("TOPIC"))},
               [](ReadingChoices& choices, const Call& call) {
                 choices.streams.joint = named(call, 0);
                 choices.streams.motor = named(call, 1);
               }),
      choosing({"choose-stamps", "Stamps",
                "On the page: the stamps that are used for laser and motor, the header's or those of "
                "receiving."},
               {choice_of("WHICH", {"detected", "header", "receive"})},
               [](ReadingChoices& choices, const Call& call) {
                 choices.stamps = call.text(0) == "header" ? StampSource::kHeader : StampSource::kReceive;
                 if (call.text(0) == "detected") choices.stamps.reset();
               }),
      choosing({"choose-rig", "Rig file",
                "On the page: a file (YAML) with topics, joint, stamps and the laser's place on the "
                "motor. None: no file."},
               {optional_of(file_read("FILE"))},
               [](ReadingChoices& choices, const Call& call) { choices.rig_file = call.text(0); }),
      choosing({"choose-poses", "Trajectory",
                "On the page: a file (TUM) with the rig's known trajectory, used instead of solving "
                "for it. None: no file."},
               {optional_of(file_read("FILE"))},
               [](ReadingChoices& choices, const Call& call) { choices.poses = call.text(0); }),
      choosing({"choose-part", "Time range",
                "On the page: the part of the recording that is used, in seconds since the first "
                "scan. Both 0: all of it."},
               {number_of("FROM", "s", 0, 1e7, 0.1), number_of("TO", "s", 0, 1e7, 0.1)}, choose_part),
      action({"open-chosen", "Open", "Opens the recording with the choices of the page."}, {}, open_chosen),
  };
}

}  // namespace

std::vector<Command> opening_commands() {
  std::vector<Command> all{
      action({"open", "Open a recording",
              "A recording (a ROS 1 or ROS 2 bag, or a folder of CSV tables), with the trajectory "
              "of the rig (TUM) if it is known; a saved session; or an estimate written as JSON."},
             {file_read("FILE"), optional_of(file_read("POSES"))}, open),
      action(
          {"sample", "Open a simulated sample",
           "A recording whose true offset is known to be 24 ms: a room, or the first seconds of a walk."},
          {choice_of("SCENE", simulation::scene_names()), optional_of(number_of("SECONDS", "s", 1, 300, 0))},
          [](Explorer& explorer, const Call& call) { explorer.load_sample(call.text(0), seconds_of(call)); }),
  };
  std::ranges::move(commands_of_page(), std::back_inserter(all));
  all.push_back(action(
      {"reopen", "Open again otherwise",
       "The recording that is open, with other stamps, without its rig file, the part in "
       "which the rig was stationary, or all of it."},
      {choice_of("HOW", {"receive-stamps", "header-stamps", "without-rig-file", "stationary-part", "whole"})},
      reopen, Need::kRecording));
  all.push_back(
      action({"add-recording", "Add a recording of this rig",
              "To the one that is open, for one answer from all of them. It is read like that one."},
             {file_read("FILE")}, add_recording, Need::kRecording));
  all.push_back(action(
      {"leave-out", "Leave a recording out", "Of the list of recordings of this rig, by its number."},
      {number_of("NUMBER", "", 1, 1000, 1)},
      [](Explorer& explorer, const Call& call) {
        return explorer.rig.leave_out(explorer.loaded(), static_cast<std::size_t>(call.number(0)));
      },
      Need::kRecording));
  all.push_back(
      action({"estimate-together", "Estimate from all recordings",
              "One offset, and what else is solved for, from all recordings of this rig; or with \"each\" "
              "an offset for each."},
             {optional_of(choice_of("OFFSETS", {"one", "each"}))}, estimate_together, Need::kRecording));
  all.push_back(action({"close", "Close the recording", "Back to the start page."}, {},
                       [](Explorer& explorer, const Call&) { explorer.close(); }));
  return all;
}

}  // namespace sweepscope::ui
