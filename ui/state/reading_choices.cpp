#include "ui/state/reading_choices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/io/printable_text.hpp"
#include "core/numbers.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/offset/search/stationary_part.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/recording/formats/read_raw_recording.hpp"

namespace sweepscope::ui {
namespace {

using Json = nlohmann::ordered_json;

std::string stamps_in_words(const Recording& recording) {
  const StreamStamps &laser = recording.report.laser_stamps, &motor = recording.report.motor_stamps;
  std::string words = laser.used == motor.used ? fmt::format("Detected: {} stamps.", name_of(laser.used))
                                               : fmt::format(
                                                     "Detected: {} stamps for the laser, {} stamps "
                                                     "for the motor.",
                                                     name_of(laser.used), name_of(motor.used));
  if (!laser.receive_minus_header_s) return words;
  const double late_s = *laser.receive_minus_header_s;
  if (late_s < 0) return words + fmt::format(" Header stamps are {:.2f} s ahead of receive times.", -late_s);
  return words + fmt::format(" Scans were received {:.1f} ms after their header stamps.", late_s * 1e3);
}

std::string motor_in_words(const Recording& recording) {
  const auto& angles_rad = recording.motor.angle_rad;
  if (angles_rad.empty()) return "";
  const auto [min, max] = std::ranges::minmax(angles_rad);
  return fmt::format("Angles in {}: from {:.1f}° to {:.1f}°.", name_of(recording.rig.motor.unit),
                     min * kDegPerRad, max * kDegPerRad);
}

/// `by`: what says so.
std::string mount_in_words(const Eigen::Vector3d& axis, const std::string& by) {
  return with_named_axes(fmt::format("The motor turns the laser about [{:.3g}, {:.3g}, {:.3g}]{}.",
                                     axis.x() + 0.0, axis.y() + 0.0, axis.z() + 0.0, by));
}

/// The recording as its surfaces show that it is to be read, with what they show in words.
Recording read_by_surfaces(Recording recording, const ReadOptions& options, ReadingSurvey& found,
                           const Job& job) {
  const RankedReadings ranked = rank_unstated(recording, options, job);
  found.readings = ranked.beams;
  found.reading_note = reading_in_words(ranked.beams);
  if (found.reading_note.empty())
    found.reading_note = options.rig && options.rig->laser.time_increment_s
                             ? "The beams are timed as the rig file says."
                             : "The beams are timed as recorded: the surfaces do not show another order.";
  found.reading_note[0] = char(std::toupper(static_cast<unsigned char>(found.reading_note[0])));
  if (!(options.rig && options.rig->states_mount()) && recording.rig.states_mount())
    found.mount_note = mount_in_words(recording.rig.mount.axis, ", by the recording's transforms");
  if (ranked.axis_is_found) {
    recording.rig.mount.axis = ranked.axis;
    found.mount_note = mount_in_words(ranked.axis, ", as the surfaces show");
  }
  const BeamReading* chosen = chosen_of(ranked.beams);
  if (chosen == nullptr || chosen->kind == BeamReadingKind::kRecorded) return recording;
  return read_as(recording, chosen->time_increment_s);
}

void note_recording(Recording recording, const ReadOptions& options, ReadingSurvey& found, const Job& job) {
  found.stamps_note = stamps_in_words(recording);
  found.motor_note = motor_in_words(recording);
  if (recording.scans.empty()) return;
  found.duration_s = recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
  const auto prepared =
      prepare(std::make_shared<const Recording>(read_by_surfaces(std::move(recording), options, found, job)),
              FeatureOptions(), job);
  if (prepared) found.motion = motion_course(*prepared, job).parts;
}

/// A key's text; empty without one.
Result<std::string> text_of(const Json& json, const char* key, const std::string& name) {
  const auto found = json.find(key);
  if (found == json.end()) return std::string();
  if (found->is_string()) return found->get<std::string>();
  return unreadable(fmt::format("{}: reading.{}: not a text", name, key));
}

Result<void> read_window(const Json& json, const std::string& name, ReadingChoices& choices) {
  const auto found = json.find("window_s");
  if (found == json.end()) return {};
  const bool numbers =
      found->is_array() && found->size() == 2 && (*found)[0].is_number() && (*found)[1].is_number();
  const TimeWindow window =
      numbers ? TimeWindow{(*found)[0].get<double>(), (*found)[1].get<double>()} : TimeWindow{};
  if (!(window.to_s > window.from_s))
    return unreadable(fmt::format("{}: reading.window_s: not two ascending numbers of seconds", name));
  choices.window = window;
  return {};
}

}  // namespace

Result<ReadOptions> read_options(const ReadingChoices& choices) {
  ReadOptions options;
  options.stamps = choices.stamps;
  if (!choices.rig_file.empty()) {
    auto rig = read_rig(choices.rig_file);
    if (!rig) return tl::unexpected(rig.error());
    options.rig = std::move(*rig);
  }
  if (choices.streams.any()) options.rig = with_streams(options.rig.value_or(Rig()), choices.streams);
  return options;
}

std::string shell_options(const ReadingChoices& choices, bool whole) {
  std::string words;
  const auto add = [&](const char* option, const std::string& value) {
    words += fmt::format(" {} {}", option, shell_word(value));
  };
  const std::filesystem::path rig = choices.rig_file;
  if (!rig.empty()) add("--rig", whole ? rig.string() : rig.filename().string());
  if (choices.streams.laser) add("--laser", *choices.streams.laser);
  if (choices.streams.motor) add("--motor", *choices.streams.motor);
  if (choices.streams.joint) add("--joint", *choices.streams.joint);
  if (choices.stamps) add("--stamps", name_of(*choices.stamps));
  if (choices.window) words += fmt::format(" --window {}:{}", choices.window->from_s, choices.window->to_s);
  return words;
}

ReadingChoices merged(ReadingChoices base, const ReadingChoices& given) {
  if (!given.poses.empty()) base.poses = given.poses;
  if (!given.rig_file.empty()) base.rig_file = given.rig_file;
  if (given.streams.laser) base.streams.laser = given.streams.laser;
  if (given.streams.motor) base.streams.motor = given.streams.motor;
  if (given.streams.joint) base.streams.joint = given.streams.joint;
  if (given.stamps) base.stamps = given.stamps;
  if (given.window) base.window = given.window;
  return base;
}

Json to_json(const ReadingChoices& choices) {
  Json json;
  if (!choices.rig_file.empty()) json["rig"] = choices.rig_file;
  if (choices.streams.laser) json["laser"] = *choices.streams.laser;
  if (choices.streams.motor) json["motor"] = *choices.streams.motor;
  if (choices.streams.joint) json["joint"] = *choices.streams.joint;
  if (choices.stamps) json["stamps"] = name_of(*choices.stamps);
  if (choices.window) json["window_s"] = {choices.window->from_s, choices.window->to_s};
  return json;
}

Result<ReadingChoices> reading_from_json(const Json& json, const std::string& name) {
  if (!json.is_object()) return unreadable(fmt::format("{}: reading: not a JSON object", name));
  ReadingChoices choices;
  std::string stamps;
  const auto optional_into = [](std::optional<std::string>& member) {
    return [&member](const std::string& text) {
      if (!text.empty()) member = text;
    };
  };
  const std::vector<std::pair<const char*, std::function<void(const std::string&)>>> kTexts{
      {"rig", [&](const std::string& text) { choices.rig_file = text; }},
      {"laser", optional_into(choices.streams.laser)},
      {"motor", optional_into(choices.streams.motor)},
      {"joint", optional_into(choices.streams.joint)},
      {"stamps", [&](const std::string& text) { stamps = text; }}};
  for (const auto& [key, set] : kTexts)
    if (const auto done = text_of(json, key, name).map(set); !done) return tl::unexpected(done.error());
  if (!stamps.empty() && stamps != "header" && stamps != "receive")
    return unreadable(fmt::format("{}: reading.stamps: \"{}\" is neither header nor receive", name, stamps));
  if (!stamps.empty()) choices.stamps = stamps == "header" ? StampSource::kHeader : StampSource::kReceive;
  if (const auto read = read_window(json, name, choices); !read) return tl::unexpected(read.error());
  return choices;
}

std::string with_named_axes(std::string text) {
  for (const auto& [axis, name] : {std::pair{"[1, 0, 0]", "x"}, {"[0, 1, 0]", "y"}, {"[0, 0, 1]", "z"}})
    for (std::size_t at = 0; (at = text.find(axis, at)) != text.npos;)
      text.replace(at, std::string_view(axis).size(), name);
  return text;
}

Result<ReadingSurvey> survey_file(const ReadingChoices& choices, const Job& job) {
  const auto options = read_options(choices);
  const Rig rig = options ? options->rig.value_or(Rig())
                          : with_streams(Rig(), choices.streams);  // a rig file that cannot be read is named
  auto raw = read_raw_recording(choices.file, without_streams(rig), job);
  if (!raw) return tl::unexpected(raw.error());
  ReadingSurvey found;
  if (!options) found.problem = options.error().message;
  found.streams = survey(*raw, rig);
  found.mount_note = choices.rig_file.empty() ? "Without a rig file the motor rolls the laser about x."
                                              : mount_in_words(rig.mount.axis, "");
  if (choices.rig_file.empty() && !found.streams.mount_note.empty())
    found.mount_note += " " + with_named_axes(found.streams.mount_note);
  if (!found.streams.complete() || job.cancelled()) return found;
  auto recording = assemble(std::move(*raw), rig, choices.stamps);
  if (recording)
    note_recording(std::move(*recording), options.value_or(ReadOptions()), found, job);
  else if (found.problem.empty())
    found.problem = recording.error().message;
  return found;
}

}  // namespace sweepscope::ui
