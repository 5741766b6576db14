#include "core/offset/readings/fitting_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

// How to read the recording where it has to be read again, otherwise nothing.
std::optional<ReadOptions> other_options(ReadOptions options, const Recording& read,
                                         const RankedReadings& ranked) {
  const BeamReading* chosen = chosen_of(ranked.beams);
  const bool beams_differ = chosen != nullptr && chosen->kind != BeamReadingKind::kRecorded;
  if (!beams_differ && !ranked.axis_is_found) return std::nullopt;
  options.rig = options.rig.value_or(Rig{});
  options.rig->laser.topic = read.rig.laser.topic;
  options.rig->mount.axis = ranked.axis;
  if (!beams_differ) return options;
  options.rig->laser.time_increment_s = chosen->time_increment_s;
  options.rig->laser.increment_is_found = true;
  return options;
}

std::string axis_warning(const RankedReadings& ranked) {
  return fmt::format(
      "The motor turns the laser about its y axis, as the surfaces show: walls are flat then, and bent about x. Set "
      "mount: {{axis: [{:g}, {:g}, {:g}]}} in a rig file to state it.",
      ranked.axis.x(), ranked.axis.y(), ranked.axis.z());
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
void add_readings(const RankedReadings& ranked, const Recording& read, ReadReport& report) {
  const std::vector<BeamReading>& readings = report.readings = ranked.beams;
  if (ranked.axis_is_found) report.warnings.push_back(axis_warning(ranked));
  if (const BeamReading* chosen = chosen_of(readings)) {
    report.beam_time_doubt_s = 0;
    if (chosen != &readings.front()) report.warnings.push_back(warning_of(readings, *chosen, read));
    return;
  }
  const auto residual_m = [](const BeamReading& reading) { return reading.residual_m.value_or(0); };
  double best_m = std::numeric_limits<double>::infinity();
  for (const BeamReading& reading : readings)
    if (reading.offset_s) best_m = std::min(best_m, residual_m(reading));
  std::vector<const BeamReading*> alike;
  for (const BeamReading& reading : readings)
    if (reading.offset_s && best_m > kClearlyBetter * residual_m(reading)) alike.push_back(&reading);
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
  const RankedReadings ranked = rank_readings(*recording, job);
  if (const auto other = other_options(options, *recording, ranked))
    recording = read_recording(path, *other, job);
  if (recording) add_readings(ranked, *recording, recording->report);
  return recording;
}

Result<RecordingFile> open_fitting(const std::filesystem::path& path, const ReadOptions& options,
                                   const Job& job) {
  auto file = RecordingFile::open(path, options, job);
  if (!file || is_stated(options)) return file;
  constexpr double kFirst_s = 60;
  const auto first = file->parts({{0, kFirst_s}}, job);
  if (!first) return tl::unexpected(first.error());
  const RankedReadings ranked = rank_readings(*first, job);
  if (const auto other = other_options(options, *first, ranked))
    file = RecordingFile::open(path, *other, job);
  if (file) add_readings(ranked, *first, file->report());
  return file;
}

}  // namespace sweepscope
