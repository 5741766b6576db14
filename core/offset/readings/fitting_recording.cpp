#include "core/offset/readings/fitting_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/offset/readings/beam_readings.hpp"

namespace sweepscope {
namespace {

const BeamReading* chosen_of(const std::vector<BeamReading>& readings) {
  const auto found = std::ranges::find_if(readings, &BeamReading::chosen);
  return found == readings.end() ? nullptr : &*found;
}

bool is_stated(const ReadOptions& options) {
  return options.rig && options.rig->laser.time_increment_s;
}

// The rig that a recording was read with, and another reading.
ReadOptions with_reading(ReadOptions options, const Recording& read, const BeamReading& reading) {
  options.rig = options.rig.value_or(Rig{});
  options.rig->laser.topic = read.rig.laser.topic;
  options.rig->laser.time_increment_s = reading.time_increment_s;
  options.rig->laser.increment_is_found = true;
  return options;
}

std::string warning_of(const std::vector<BeamReading>& readings, const BeamReading& chosen,
                       const Recording& read) {
  const auto residual = [](const BeamReading& reading) {
    return reading.residual_m ? fmt::format("{:.1f} mm", *reading.residual_m * 1e3) : "no match";
  };
  return fmt::format(
      "{}: {}, as the surfaces show (sweeps of opposite directions are {} apart, {} as recorded). Set laser: "
      "{{time_increment_s: {:.6g}}} in a rig file to state it.",
      *read.rig.laser.topic, description_of(chosen.kind), residual(chosen), residual(readings.front()),
      chosen.time_increment_s);
}

// What is known of the beams' times after the readings were ranked.
void add_readings(const std::vector<BeamReading>& readings, const Recording& read, ReadReport& report) {
  report.readings = readings;
  if (const BeamReading* chosen = chosen_of(readings)) {
    report.beam_time_doubt_s = 0;
    if (chosen != &readings.front()) report.warnings.push_back(warning_of(readings, *chosen, read));
    return;
  }
  std::vector<const BeamReading*> alike;
  for (const BeamReading& reading : readings)
    if (reading.offset_s) alike.push_back(&reading);
  for (const BeamReading* one : alike)
    for (const BeamReading* other : alike)
      report.beam_time_doubt_s =
          std::max(report.beam_time_doubt_s, 2 * std::abs(*one->offset_s - *other->offset_s));
}

}  // namespace

std::string description_of(BeamReadingKind kind) {
  switch (kind) {
    case BeamReadingKind::kRecorded:
      return "the beams are timed as recorded";
    case BeamReadingKind::kReversed:
      return "the last beam of a message was fired first";
    case BeamReadingKind::kAtOnce:
      return "all beams of a message were fired at once";
    case BeamReadingKind::kMirror:
      return "the mirror turns once from scan to scan";
    case BeamReadingKind::kMirrorReversed:
      return "the mirror turns once from scan to scan, and the last beam of a message was fired first";
    case BeamReadingKind::kPeriod:
      return "a scan takes all of the time from scan to scan";
    case BeamReadingKind::kPeriodReversed:
      return "a scan takes all of the time from scan to scan, and the last beam of a message was fired first";
  }
  return "";
}

Result<Recording> read_fitting(const std::filesystem::path& path, const ReadOptions& options,
                               const Job& job) {
  auto recording = read_recording(path, options, job);
  if (!recording || is_stated(options)) return recording;
  const std::vector<BeamReading> readings = rank_readings(*recording, job);
  const BeamReading* chosen = chosen_of(readings);
  if (chosen != nullptr && chosen != &readings.front())
    recording = read_recording(path, with_reading(options, *recording, *chosen), job);
  if (recording) add_readings(readings, *recording, recording->report);
  return recording;
}

Result<RecordingFile> open_fitting(const std::filesystem::path& path, const ReadOptions& options,
                                   const Job& job) {
  auto file = RecordingFile::open(path, options, job);
  if (!file || is_stated(options)) return file;
  constexpr double kFirst_s = 60;
  const auto first = file->parts({{0, kFirst_s}}, job);
  if (!first) return tl::unexpected(first.error());
  const std::vector<BeamReading> readings = rank_readings(*first, job);
  const BeamReading* chosen = chosen_of(readings);
  if (chosen != nullptr && chosen != &readings.front())
    file = RecordingFile::open(path, with_reading(options, *first, *chosen), job);
  if (file) add_readings(readings, *first, file->report());
  return file;
}

}  // namespace sweepscope
