#include "core/offset/identifiability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "core/numbers.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

// Of a 3D scanner the first ring's.
std::vector<double> scan_stamps_s(const Recording& recording) {
  std::vector<double> stamps_s;
  for (const LaserScan& scan : recording.scans)
    if (scan.ring == recording.scans.front().ring) stamps_s.push_back(scan.first_beam_s);
  return stamps_s;
}

double median_cost(const std::vector<CurvePoint>& coarse) {
  std::vector<double> costs;
  for (const CurvePoint& point : coarse)
    if (point.capped_cost_m) costs.push_back(*point.capped_cost_m);
  return median(costs);
}

}  // namespace

Remark edge_reason(const std::vector<CurvePoint>& coarse, std::size_t best) {
  if (best > 0 && best + 1 < coarse.size()) return std::nullopt;
  return fmt::format(
      "The minimum cost lies on the edge of the searched range, at {:.1f} ms: the offset is outside the "
      "range or cannot be determined.",
      coarse[best].offset_s * 1e3);
}

Remark rival_reason(const std::vector<CurvePoint>& coarse, std::size_t best, const SearchScale& scale) {
  // No simulated room or walk has a second valley; see tests/benchmark/thresholds.
  constexpr double kApart = 8;   // units
  constexpr double kLike = 0.2;  // of the least one's depth
  const double min_m = *coarse[best].capped_cost_m, depth_m = median_cost(coarse) - min_m;
  for (std::size_t i = 1; i + 1 < coarse.size(); ++i) {
    const auto &before = coarse[i - 1].capped_cost_m, &here = coarse[i].capped_cost_m,
               &after = coarse[i + 1].capped_cost_m;
    if (!before || !here || !after || !(*here < *before) || !(*here <= *after)) continue;
    if (std::abs(coarse[i].offset_s - coarse[best].offset_s) < kApart * scale.unit_s) continue;
    if (*here - min_m < kLike * depth_m)
      return fmt::format("Two offsets fit about equally well: {:.0f} ms and {:.0f} ms.",
                         coarse[best].offset_s * 1e3, coarse[i].offset_s * 1e3);
  }
  return std::nullopt;
}

Remark flat_reason(const std::vector<CurvePoint>& coarse, std::size_t best) {
  constexpr double kMinDepth =
      0.15;  // 0.68 to 0.86 of simulated rooms and walks, see tests/benchmark/thresholds
  const double min_m = *coarse[best].capped_cost_m, median_m = median_cost(coarse);
  if (median_m - min_m > kMinDepth * median_m) return std::nullopt;
  // A third of the most that a distance counts for: not noise.
  constexpr double kFitsNowhere_m = 0.1;
  if (min_m > kFitsNowhere_m)
    return fmt::format(
        "Sweeps of opposite directions do not fit each other at any offset ({:.0f} mm apart at best): the "
        "rig or the scene moved, or its surfaces are too rough.",
        min_m * 1e3);
  return fmt::format(
      "The scene does not constrain the offset: sweeps of opposite directions fit each other about equally "
      "well at every offset ({:.1f} mm apart at best, {:.1f} mm at the median).",
      min_m * 1e3, median_m * 1e3);
}

Remark unrepeated_lines_reason(const Recording& recording) {
  constexpr std::size_t kLines = 400, kBeams = 7;
  constexpr double kMaxApart_rad = 5 * kRadPerDeg;  // rings and slices of turns repeat themselves to a degree
  if (recording.directions.empty()) return std::nullopt;
  std::map<std::uint16_t, const LaserScan*> first_of_ring;
  std::vector<double> apart_rad;
  const std::size_t stride = std::max<std::size_t>(1, recording.scans.size() / kLines);
  for (std::size_t i = 0; i < recording.scans.size(); i += stride) {
    const LaserScan& line = recording.scans[i];
    const LaserScan& first = *first_of_ring.try_emplace(line.ring, &line).first->second;
    for (std::uint32_t beam = 0; beam < std::min(line.beams, first.beams); beam += kBeams) {
      const Eigen::Vector3d a = recording.direction(first, beam), b = recording.direction(line, beam);
      if (&line != &first && !a.isZero() && !b.isZero())
        apart_rad.push_back(std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  if (median(std::move(apart_rad)) < kMaxApart_rad) return std::nullopt;
  return "The scanner's lines do not repeat, and the direct method compares equal beams of a stationary rig. "
         "Use the stationary method (--method stationary).";
}

Remark stamps_reason(const Recording& recording, const SearchScale& scale) {
  constexpr std::size_t kMinScans = 20;  // so that two spacings lie beyond nine in ten
  if (recording.report.laser_stamps.used != StampSource::kReceive) return std::nullopt;
  if (recording.scans.size() < kMinScans) return std::nullopt;
  const double spread_s = unevenness_s(scan_stamps_s(recording)),
               period_s = recording.report.laser_stamps.median_period_s;
  if (spread_s < std::max(period_s / 4, scale.unit_s / 2)) return std::nullopt;
  return fmt::format(
      "The scans' receive times are uneven (90 % within {:.0f} ms), and a scan takes {:.0f} ms: when each "
      "scan was taken is not known, and no constant offset can correct that.",
      spread_s * 1e3, period_s * 1e3);
}

Remark gaps_reason(const Recording& recording, const std::vector<char>& covered, double min_s, double max_s) {
  const MotorTrack& motor = recording.motor;
  std::size_t within = 0, used = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    if (scan.first_beam_s + min_s < motor.time_s.front()) continue;
    if (scan.last_beam_s() + max_s > motor.time_s.back()) continue;
    ++within;
    used += covered[i] ? 1 : 0;
  }
  if (2 * used >= within) return std::nullopt;
  return fmt::format("Most scans lie in gaps of the motor's samples: only {} of {} have samples around them.",
                     used, within);
}

Remark drift_reason(const Trend& trend, double duration_s, double sigma_s) {
  const double apart_s = std::abs(trend.slope) * duration_s;
  const double chance_s = 3 * trend.sigma * duration_s;
  if (apart_s < std::max({1e-3, 3 * sigma_s, chance_s})) return std::nullopt;
  return fmt::format(
      "The clocks drift apart by {:.0f} ppm: by {:.1f} ms over these {:.1f} s. Search over time for the "
      "offset and its rate (estimate --over-time).",
      trend.slope * 1e6, trend.slope * duration_s * 1e3, duration_s);
}

Remark lever_reason(double lever_m, double reach_m) {
  constexpr double kMinLever =
      0.05;  // 0.38 to 0.61 of simulated rooms and walks, see tests/benchmark/thresholds
  if (lever_m > kMinLever * reach_m) return std::nullopt;
  return fmt::format(
      "The scene does not constrain the offset: turning the motor by 1 deg moves the points only {:.1f} mm "
      "away from their surfaces.",
      lever_m * kRadPerDeg * 1e3);
}

double samples_per_sweep(const MotorTrack& track, const MotorMotion& motor) {
  const double spacing_s = spacing(track.time_s, 1).median_s;
  return spacing_s > 0 ? motor.median_sweep_s / spacing_s : 0;
}

double encoder_step_sigma_s(const MotorTrack& track, const MotorMotion& motor) {
  // Steps and samples beat: neighbouring samples have the same error, and the next sweeps of both directions
  // repeat it. Found by simulation.
  constexpr double kMaxIndependent = 32;
  constexpr double kSame_rad = 1e-7;  // rounding: no encoder has 26 bits
  std::vector<double> angles_rad = track.angle_rad;
  // A motor that turns one way never comes back to an angle; what it turns between samples is in steps too.
  if (motor.one_way()) std::adjacent_difference(angles_rad.begin(), angles_rad.end(), angles_rad.begin());
  std::sort(angles_rad.begin(), angles_rad.end());
  double step_rad = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < angles_rad.size(); ++i)
    if (const double gap_rad = angles_rad[i] - angles_rad[i - 1]; gap_rad > kSame_rad)
      step_rad = std::min(step_rad, gap_rad);
  if (!std::isfinite(step_rad)) return 0;
  const double independent = std::clamp(2 * samples_per_sweep(track, motor), 1.0, kMaxIndependent);
  return step_rad / motor.lever_speed_rad_s() / std::sqrt(12 * independent);
}

double encoder_sampling_sigma_s(const MotorTrack& track, const MotorMotion& motor) {
  // Found by simulation of motors that turn evenly, with ramps and as a sine, 3 to 20 samples a sweep; shown
  // by tests/benchmark/laws.
  constexpr double kOfASweep = 2;
  const double samples = samples_per_sweep(track, motor);
  return samples > 0 ? kOfASweep * motor.median_sweep_s / std::pow(samples, 5) : 0;
}

double lines_sigma_s(const MotorMotion& motor, double distinct_lines) {
  // Found by simulation of sweeps that take 7 to 20 scans, in rooms; shown by tests/benchmark/laws.
  constexpr double kOfASweep = 0.115;
  return kOfASweep * motor.median_sweep_s / std::pow(distinct_lines, 3);
}

double stamps_sigma_s(const Recording& recording) {
  constexpr double kNineInTenOfSpacings = 1.645 * std::numbers::sqrt2;  // standard deviations of a stamp
  // A part of the scans decides; found by simulation of rooms, shown by tests/benchmark/laws.
  constexpr double kConcentration = 1.75;
  const std::vector<double> stamps_s = scan_stamps_s(recording);
  if (stamps_s.empty()) return 0;
  return kConcentration * unevenness_s(stamps_s) / kNineInTenOfSpacings / std::sqrt(double(stamps_s.size()));
}

double beam_times_sigma_s(const Recording& recording) {
  return recording.report.beam_time_doubt_s / 2;
}

Remark beam_times_reason(const Recording& recording, const SearchScale& scale) {
  if (beam_times_sigma_s(recording) < scale.unit_s) return std::nullopt;
  return fmt::format(
      "When the beams were fired is not known: the time of the last beam of a scan may be off by {:.1f} ms. "
      "Set laser.time_increment_s in a rig file.",
      recording.report.beam_time_doubt_s * 1e3);
}

double unseen_sigma_s(const Recording& recording, const MotorMotion& motor, double offset_s) {
  const double of_motor_and_lines_s = std::hypot(
      encoder_step_sigma_s(recording.motor, motor), encoder_sampling_sigma_s(recording.motor, motor),
      lines_sigma_s(motor, distinct_lines(recording, motor, offset_s)));
  const double of_beams_s = beam_times_sigma_s(recording);
  return of_beams_s > 0 ? std::hypot(of_motor_and_lines_s, of_beams_s) : of_motor_and_lines_s;
}

Remark lines_reason(double distinct_lines) {
  if (distinct_lines >= kMinDistinctLines) return std::nullopt;
  return fmt::format(
      "All sweeps of a direction have the same {:.2g} scan lines, too few to match the surfaces of both "
      "directions. Turn the motor more slowly, or make the sweeps a little longer or shorter.",
      distinct_lines);
}

Remark sampling_reason(const MotorTrack& track, const MotorMotion& motor, const SearchScale& scale) {
  constexpr double kMin = 3;  // the law of encoder_sampling_sigma_s is known down to it
  const double samples = samples_per_sweep(track, motor);
  if (samples > kMin && encoder_sampling_sigma_s(track, motor) < scale.unit_s) return std::nullopt;
  return fmt::format("The motor is sampled only {:.1f} times per sweep: its motion in between is not known.",
                     samples);
}

Remark sigma_reason(std::optional<double> sigma_s, const SearchScale& scale) {
  if (!sigma_s) return std::string("There is too little information to estimate an uncertainty.");
  if (*sigma_s < scale.unit_s) return std::nullopt;
  return fmt::format("There is too little information: the offset would be uncertain by +- {:.1f} ms.",
                     *sigma_s * 1e3);
}

namespace {

double scans_a_sweep(const Recording& recording, const MotorMotion& motor) {
  const std::vector<double> stamps_s = scan_stamps_s(recording);
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < stamps_s.size(); ++i) periods_s.push_back(stamps_s[i] - stamps_s[i - 1]);
  const double period_s = median(periods_s);
  return period_s > 0 ? motor.median_sweep_s / period_s : 0;
}

}  // namespace

bool sees_same_angles(const Recording& recording, const MotorMotion& motor, std::size_t sweeps) {
  const double scans = scans_a_sweep(recording, motor);
  if (!(scans > 0) || sweeps < 4 || scans > 60) return false;
  // Over all sweeps the angles shift by less than a quarter of a line's spacing.
  return std::abs(scans - std::round(scans)) * double(sweeps) < 0.25;
}

Remark aliased_warning(const Recording& recording, const MotorMotion& motor) {
  if (!sees_same_angles(recording, motor, motor.sweeps.size())) return std::nullopt;
  return fmt::format(
      "A sweep lasts almost exactly {:.0f} scans: every sweep measures at the same angles, and few surfaces "
      "are measured twice. A slightly slower or faster motor gives a better answer.",
      std::round(scans_a_sweep(recording, motor)));
}

namespace {

constexpr double kShortSweep_s = 0.5;  // shorter ones leave no less in doubt

// How much longer than those, as far as that matters.
double longer_than_short(const Recording& recording, const MotorMotion& motor) {
  return has_rings(recording) ? 1 : std::max(1.0, motor.median_sweep_s / kShortSweep_s);
}

// By how much a sweep may turn about the motor's axis unseen. The constants: what the scatter of the parts of
// the 14 walks of tuning/ in tests/benchmark/walks leaves unexplained. The power: a motor of sweeps of 0.7 s
// and more goes to and fro as slowly as people sway; of the last 126 walks of tests/benchmark/random_walks
// 200 1, 99 % lie within 3 sigma with it, and 93 % with a square.
double unseen_rad(double longer, bool same_angles) {
  constexpr double kUnseen_rad = 0.6e-3, kPower = 3.5, kUnseenOfSameAngles_rad = 1.7e-3;
  const double bent_rad = kUnseen_rad * std::pow(longer, kPower);
  return same_angles ? std::max(bent_rad, kUnseenOfSameAngles_rad * longer * longer) : bent_rad;
}

}  // namespace

std::size_t sweeps_of_part(const MotorMotion& motor) {
  return std::size_t(10 / motor.median_sweep_s);
}

bool has_rings(const Recording& recording) {
  return std::any_of(recording.scans.begin(), recording.scans.end(),
                     [&](const LaserScan& scan) { return scan.ring != recording.scans.front().ring; });
}

Remark long_sweeps_warning(const Recording& recording, const MotorMotion& motor, double unseen_s,
                           double sigma_s) {
  const double longer = longer_than_short(recording, motor);
  if (longer < 1.2 || unseen_s < sigma_s / 2) return std::nullopt;
  const bool same_angles = sees_same_angles(recording, motor, sweeps_of_part(motor));
  const double short_s = unseen_s * unseen_rad(1, same_angles) / unseen_rad(longer, same_angles) /
                         longer;  // the motor would turn faster, too
  return fmt::format(
      "A sweep takes {:.2f} s, long enough for the rig to sway within it: this alone makes the offset "
      "uncertain by +- {:.2f} ms. With sweeps of {:.1f} s it would be +- {:.2f} ms.",
      motor.median_sweep_s, unseen_s * 1e3, kShortSweep_s, short_s * 1e3);
}

Remark smooth_motor_warning(double sway_s, double sigma_s) {
  if (sway_s < sigma_s / 2) return std::nullopt;
  return fmt::format(
      "The motor slows down before it turns back, so a sway of the rig in step with it looks like an offset: "
      "this alone makes the offset uncertain by +- {:.2f} ms. A motor that turns at constant speed and "
      "reverses at once does not have this limit.",
      sway_s * 1e3);
}

double unseen_of_part_s(const Recording& recording, const MotorMotion& motor, std::size_t sweeps) {
  const bool same_angles = sees_same_angles(recording, motor, sweeps);
  return unseen_rad(longer_than_short(recording, motor), same_angles) / motor.median_speed_rad_s;
}

Remark encoder_warning(const MotorTrack& track) {
  std::vector<double> spacings_s;
  for (std::size_t i = 1; i < track.time_s.size(); ++i)
    spacings_s.push_back(track.time_s[i] - track.time_s[i - 1]);
  const double median_s = median(spacings_s);
  if (spacings_s.size() < 4) return std::nullopt;
  std::sort(spacings_s.begin(), spacings_s.end());
  const double quartiles_s = spacings_s[3 * spacings_s.size() / 4] - spacings_s[spacings_s.size() / 4];
  const double jitter_s = quartiles_s / 1.349;  // as of a normal distribution
  if (jitter_s < 0.2 * median_s) return std::nullopt;
  return fmt::format("The encoder's samples are uneven: every {:.1f} ms +- {:.1f} ms.", median_s * 1e3,
                     jitter_s * 1e3);
}

Remark sampling_warning(const MotorTrack& track, const MotorMotion& motor) {
  constexpr double kFew = 8;  // below, 2 T n^-5 is more than 0.03 ms of a sweep of 0.5 s
  const double samples = samples_per_sweep(track, motor);
  if (samples > kFew) return std::nullopt;
  return fmt::format(
      "The motor is sampled only {:.1f} times per sweep: between samples its speed is assumed to be "
      "constant.",
      samples);
}

Remark slow_motor_warning(const MotorMotion& motor) {
  const double turned_deg = motor.lever_speed_rad_s() * 1e-3 / kRadPerDeg;
  if (turned_deg > 0.1) return std::nullopt;
  return fmt::format("The motor turns slowly: 1 ms is only {:.3f} deg here.", turned_deg);
}

Remark few_matches_warning(std::size_t matches, std::size_t features) {
  if (10 * matches > features) return std::nullopt;
  return fmt::format("Only {} of {} features were matched.", matches, features);
}

}  // namespace sweepscope
