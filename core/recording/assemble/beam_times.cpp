#include "core/recording/assemble/beam_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numbers.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kLongestTimeIncrement_s = 1.0;
constexpr double kAlike = 1.25, kSameTime = 1.1;
constexpr double kSameReading = 1.02;  // some percent shift the offset of a fast motor by half a millisecond
constexpr int kMaxTurns = 10;          // of the mirror from one scan to the next
constexpr double kFullTurn = 2 * std::numbers::pi;

bool alike(double a, double b, double factor = kAlike) {
  return a < factor * b && b < factor * a;
}

/// One of a driver that leaves out scans may be a turn of the mirror.
bool plausible_scan_time(double scan_time_s, double period_s, double factor = kAlike) {
  if (!usable_increment(scan_time_s / kMaxTurns)) return false;
  if (!(period_s > 0)) return true;
  for (int turns = 1; turns <= kMaxTurns; ++turns)
    if (alike(turns * scan_time_s, period_s, factor)) return true;
  return false;
}

IncrementFinding finding_of(const RawScan& scan, double period_s) {
  const double increment_s = double{scan.time_increment_s}, scan_time_s = double{scan.scan_time_s};
  if (!usable_increment(increment_s)) return IncrementFinding::kMissing;
  if (!(period_s > 0)) return IncrementFinding::kSound;
  const double turns_a_beam = std::abs(double{scan.angle_increment_rad}) / kFullTurn;
  const double of_mirror_s = period_s * turns_a_beam;
  if (alike(increment_s, of_mirror_s)) return IncrementFinding::kSound;
  bool skips = false;
  for (int turns = 2; turns <= kMaxTurns; ++turns) {
    if (alike(turns * scan_time_s, period_s, kSameTime) && alike(increment_s, scan_time_s * turns_a_beam))
      return IncrementFinding::kSound;
    skips = skips || alike(turns * increment_s, of_mirror_s);
  }
  if (skips) return IncrementFinding::kSkipsOrTooShort;
  return alike(increment_s, period_s / scan.beams) ? IncrementFinding::kWholePeriodOrTooLong
                                                   : IncrementFinding::kImpossible;
}

}  // namespace

bool usable_increment(double increment_s) {
  return increment_s > 0 && increment_s < kLongestTimeIncrement_s;
}

bool fired_backwards(const RawScan& scan, std::optional<double> rig_increment_s) {
  return (rig_increment_s && *rig_increment_s < 0) || usable_increment(-double{scan.time_increment_s});
}

double BeamTimes::doubt_s(double beams) const {
  return other_s > 0 ? std::abs(time_increment_s.value_or(0) - other_s) * std::max(0.0, beams - 1) : 0;
}

BeamTimes judge_beam_times(const RawScan& scan, double period_s, std::optional<double> rig_increment_s,
                           double turns) {
  BeamTimes times;
  times.finding = finding_of(scan, period_s);
  times.time_increment_s = double{scan.time_increment_s};
  const bool sound = times.finding == IncrementFinding::kSound;
  if (rig_increment_s && !(sound && alike(*rig_increment_s, double{scan.time_increment_s}))) {
    times.time_increment_s = *rig_increment_s;
    times.of_rig = true;
    return times;
  }
  if (sound) return times;
  const bool guessed =
      times.finding == IncrementFinding::kMissing || times.finding == IncrementFinding::kImpossible;
  const double scan_time_s = double{scan.scan_time_s};
  if (guessed)
    times.time_increment_s =
        plausible_scan_time(scan_time_s, period_s) ? scan_time_s * turns / scan.beams : 0;
  if (!usable_increment(*times.time_increment_s)) {
    times.other_s = period_s * std::abs(double{scan.angle_increment_rad}) / kFullTurn;
    if (!(period_s > 0)) times.time_increment_s.reset();
    return times;
  }
  // The stamps say how long a turn takes, where scan_time disagrees with them.
  const bool agree = plausible_scan_time(scan_time_s, period_s, kSameReading);
  const double turn_s = guessed && agree ? scan_time_s : period_s;
  const double of_mirror_s = turn_s * std::abs(double{scan.angle_increment_rad}) / kFullTurn;
  // A scan of a whole turn takes its whole period by either reading.
  if (!guessed || !alike(*times.time_increment_s, of_mirror_s, kSameReading)) times.other_s = of_mirror_s;
  return times;
}

double scan_period_s(const std::vector<RawScan>& scans, StampSource stamps) {
  constexpr std::size_t kMinSpacings = 8;
  std::vector<std::int64_t> all_ns;
  all_ns.reserve(scans.size());
  for (const RawScan& scan : scans)
    if (const std::int64_t ns = stamp_ns(scan.stamps, stamps); ns != 0) all_ns.push_back(ns);
  std::ranges::sort(all_ns);
  all_ns.erase(std::ranges::unique(all_ns).begin(), all_ns.end());
  if (all_ns.size() <= kMinSpacings) return 0;
  std::vector<double> times_s;
  times_s.reserve(all_ns.size());
  for (const std::int64_t ns : all_ns) times_s.push_back(static_cast<double>(ns - all_ns.front()) * 1e-9);
  const double period_s = median(spacings(times_s));
  return unevenness_s(times_s) < period_s / 4 ? period_s : 0;
}

void BeamTimesReport::add(const RawScan& scan, const BeamTimes& times, bool explained) {
  const bool impossible = times.finding == IncrementFinding::kImpossible;
  if (!times.time_increment_s) {
    ++without_any_;
    return;
  }
  ++used_;
  doubt_sum_s_ += times.doubt_s(scan.beams);
  if (times.finding == IncrementFinding::kSound && !times.of_rig) return;
  if (times.of_rig && (explained || times.finding == IncrementFinding::kMissing)) return;
  Seen& seen = times.of_rig                                          ? corrected_
               : times.finding == IncrementFinding::kMissing         ? missing_
               : impossible                                          ? impossible_
               : times.finding == IncrementFinding::kSkipsOrTooShort ? skips_
                                                                     : whole_period_;
  if (seen.scans++ > 0) return;
  seen.scan = scan;
  seen.times = times;
}

std::string BeamTimesReport::unusable() const {
  if (without_any_ == 0) return "";
  return fmt::format(
      "{} have neither a time_increment nor a scan_time that can be right (give laser.time_increment_s in a "
      "rig file)",
      without_any_);
}

std::string BeamTimesReport::warning(const Seen& seen, const std::string& topic, double period_s) const {
  const double recorded_s = double{seen.scan.time_increment_s},
               used_s = seen.times.time_increment_s.value_or(0);
  const std::string what = fmt::format(
      "{} scans on {} have a time_increment of {:.4g} s, by which a scan takes {:.4g} s of the {:.4g} s from "
      "scan to scan",
      seen.scans, topic, recorded_s, recorded_s * (seen.scan.beams - 1.0), period_s);
  if (seen.times.of_rig) return fmt::format("{}; the rig file's {:.4g} s is used instead", what, used_s);
  constexpr const char* kHelp = "give laser.time_increment_s in a rig file";
  switch (seen.times.finding) {
    case IncrementFinding::kMissing:
    case IncrementFinding::kImpossible:
      if (used_s == 0)
        return fmt::format(
            "{} scans on {} have neither a time_increment nor a scan_time that can be right: their beams are "
            "taken as fired all at once, as simulators do, or take {:.4g} s each ({})",
            seen.scans, topic, seen.times.other_s, kHelp);
      if (seen.times.finding == IncrementFinding::kMissing)
        return fmt::format(
            "{} scans on {} have no time_increment; scan_time / beams is used, {:.4g} s, which is too long "
            "for a scanner with a blind sector ({})",
            seen.scans, topic, used_s, kHelp);
      return fmt::format("{}: its time_increment is too {}; scan_time / beams is used instead, {:.4g} s ({})",
                         what, recorded_s > used_s ? "long" : "short", used_s, kHelp);
    case IncrementFinding::kSkipsOrTooShort:
      return fmt::format(
          "{}: the driver leaves out scans, or the increment is too short and should be {:.4g} s, that of a "
          "mirror that turns once a scan ({})",
          what, seen.times.other_s, kHelp);
    case IncrementFinding::kWholePeriodOrTooLong:
      return fmt::format(
          "{}: a scan takes its whole period, or the increment is too long and should be {:.4g} s, that of a "
          "mirror that turns once a scan ({})",
          what, seen.times.other_s, kHelp);
    default:
      return what;
  }
}

std::vector<std::string> BeamTimesReport::warnings(const std::string& topic, double period_s) const {
  std::vector<std::string> all;
  for (const Seen* seen : {&missing_, &impossible_, &skips_, &whole_period_, &corrected_})
    if (seen->scans > 0) all.push_back(warning(*seen, topic, period_s));
  return all;
}

}  // namespace sweepscope
