#include "core/offset/judgement/identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/numbers.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

using enum RefusalKind;

double median_cost(const std::vector<CurvePoint>& coarse) {
  std::vector<double> costs;
  for (const CurvePoint& point : coarse)
    if (point.capped_cost_m) costs.push_back(*point.capped_cost_m);
  return median(costs);
}

}  // namespace

MaybeRefusal motor_refusal(const MotorTrack& track, const MotorMotion& motor) {
  if (track.time_s.size() < kLimits.min_motor_samples)
    return refusal(kFewMotorSamples, double(track.time_s.size()), track.time_s.size());
  if (motor.sweeps.empty())
    return refusal(kMotorDoesNotMove, motor.range_rad / kRadPerDeg, motor.range_rad / kRadPerDeg);
  const double change = motor.speeds_apart_rad_s() / motor.median_speed_rad_s;
  const bool one_speed = motor.speeds_apart_rad_s() < kLimits.min_speed_change * motor.median_speed_rad_s;
  if (motor.sweeps.size() < 2 || (motor.one_way() && one_speed))
    return refusal(kOneWayAtOneSpeed, change, motor.range_rad / kFullCircle_rad,
                   track.time_s.back() - track.time_s.front());
  return std::nullopt;
}

MaybeRefusal motor_faults_refusal(const ReadReport& report) {
  constexpr double kTurn_deg = 360, kMaxStep_turns = 0.75, kMaxSpeed_deg_s = 10 * kTurn_deg;
  const MotorFaults& faults = report.motor_faults;
  const double step_deg = faults.median_step_rad * kDegPerRad, range_deg = faults.range_rad * kDegPerRad,
               period_s = report.motor_stamps.median_period_s,
               speed_deg_s = period_s > 0 ? step_deg / period_s : 0;
  const bool far_back = faults.returned_rad * kDegPerRad > kLimits.max_swing_deg,
             steps = step_deg > kMaxStep_turns * kTurn_deg;
  if (range_deg > kLimits.max_swing_deg && (far_back || steps || speed_deg_s > kMaxSpeed_deg_s))
    return refusal(kHardlyRadians, range_deg, range_deg, speed_deg_s,
                   steps ? fmt::format(", {:.2g} turns from sample to sample", step_deg / kTurn_deg) : "");
  if (!faults.sources.empty()) return refusal(kTwoMotorSources, {}, faults.sources);
  return std::nullopt;
}

MaybeRefusal one_way_refusal(const MotorMotion& motor, RigKind kind, Method method) {
  if (!motor.one_way()) return std::nullopt;
  if (method != Method::kDirect) return refusal(kOneWayMotorAndCriteria, {});
  if (kind == RigKind::kMoving) return refusal(kOneWayMotorAndMovingRig, {});
  return std::nullopt;
}

MaybeRefusal scan_times_refusal(const Recording& recording, const SearchScale& scale) {
  constexpr std::size_t kMinScans = 20;  // so that two spacings lie beyond nine in ten
  if (recording.report.laser_stamps.used != StampSource::kReceive) return std::nullopt;
  if (recording.scans.size() < kMinScans) return std::nullopt;
  const double spread_s = unevenness_s(scan_stamps_s(recording)),
               period_s = recording.report.laser_stamps.median_period_s;
  if (spread_s < std::max(kLimits.max_scan_time_spread * period_s, scale.unit_s / 2)) return std::nullopt;
  return refusal(kUnevenScanTimes, spread_s / period_s, spread_s * 1e3, period_s * 1e3);
}

MaybeRefusal samples_refusal(const MotorTrack& track, const MotorMotion& motor, const SearchScale& scale) {
  const double samples = samples_per_sweep(track, motor);
  if (samples > kLimits.min_samples_per_sweep && encoder_sampling_sigma_s(track, motor) < scale.unit_s)
    return std::nullopt;
  return refusal(kSparseMotorSamples, samples, samples);
}

MaybeRefusal beam_times_refusal(const Recording& recording, const SearchScale& scale) {
  const double units = beam_times_sigma_s(recording) / scale.unit_s;
  if (units < kLimits.max_beam_time_sigma_units) return std::nullopt;
  std::string fitting;
  for (const BeamReading& reading : recording.report.readings)
    if (reading.offset_s)
      fitting += fmt::format("{} {:.4g}", fitting.empty() ? "; the surfaces fit with" : ",",
                             reading.time_increment_s);
  return refusal(kBeamTimesUnknown, units, recording.report.beam_time_doubt_s * 1e3, fitting);
}

MaybeRefusal gaps_refusal(const Recording& recording, const std::vector<char>& covered, double min_s,
                          double max_s) {
  const MotorTrack& motor = recording.motor;
  std::size_t within = 0, used = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    if (scan.first_beam_s + min_s < motor.time_s.front()) continue;
    if (scan.last_beam_s() + max_s > motor.time_s.back()) continue;
    ++within;
    used += covered[i] ? 1 : 0;
  }
  const double missing = double(within - used);
  if (missing <= kLimits.max_scans_in_gaps * double(within)) return std::nullopt;
  return refusal(kMotorGaps, missing / double(within), used, within);
}

MaybeRefusal lines_refusal(double distinct_lines) {
  if (distinct_lines >= kLimits.min_scan_lines) return std::nullopt;
  return refusal(kFewScanLines, distinct_lines, distinct_lines);
}

MaybeRefusal edge_refusal(const std::vector<CurvePoint>& coarse, std::size_t best) {
  if (best > 0 && best + 1 < coarse.size()) return std::nullopt;
  const double offset_ms = coarse[best].offset_s * 1e3;
  return refusal(kEdgeOfSearch, offset_ms, "cost", offset_ms);
}

MaybeRefusal rival_refusal(const std::vector<CurvePoint>& coarse, std::size_t best,
                           const SearchScale& scale) {
  const double min_m = *coarse[best].capped_cost_m, depth_m = median_cost(coarse) - min_m;
  for (std::size_t i = 1; i + 1 < coarse.size(); ++i) {
    const auto &before = coarse[i - 1].capped_cost_m, &here = coarse[i].capped_cost_m,
               &after = coarse[i + 1].capped_cost_m;
    if (!before || !here || !after || !(*here < *before) || !(*here <= *after)) continue;
    const double apart_s = std::abs(coarse[i].offset_s - coarse[best].offset_s);
    if (apart_s < kLimits.min_rival_apart_units * scale.unit_s) continue;
    if (*here - min_m < kLimits.max_rival_depth * depth_m)
      return refusal(kTwoOffsetsFit, (*here - min_m) / depth_m, coarse[best].offset_s * 1e3,
                     coarse[i].offset_s * 1e3);
  }
  return std::nullopt;
}

MaybeRefusal flat_refusal(const std::vector<CurvePoint>& coarse, std::size_t best,
                          const OffsetProblem& problem) {
  const double min_m = *coarse[best].capped_cost_m, median_m = median_cost(coarse);
  if (median_m - min_m > kLimits.min_cost_depth * median_m) return std::nullopt;
  if (min_m > kLimits.max_distance_m) return refusal(kSweepsFitNowhere, min_m, min_m * 1e3);
  if (has_few_lines(*problem.recording, problem.motor))
    return refusal(kLinesTooFarApart, lines_a_sweep(*problem.recording, problem.motor),
                   problem.line_spacing_rad * kDegPerRad);
  return refusal(kFlatCost, (median_m - min_m) / median_m, min_m * 1e3, median_m * 1e3);
}

MaybeRefusal unrepeated_lines_refusal(const Recording& recording) {
  constexpr std::size_t kLines = 400, kBeams = 7;
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
  const double median_rad = median(std::move(apart_rad));
  if (median_rad < kLimits.max_line_spread_deg * kRadPerDeg) return std::nullopt;
  return refusal(kScanLinesDoNotRepeat, median_rad / kRadPerDeg);
}

MaybeRefusal lever_refusal(double lever_m, double reach_m) {
  if (lever_m > kLimits.min_lever * reach_m) return std::nullopt;
  return refusal(kSmallLever, reach_m > 0 ? lever_m / reach_m : 0, lever_m * kRadPerDeg * 1e3);
}

MaybeRefusal long_sweeps_refusal(const Recording& recording, const MotorMotion& motor, double unseen_s,
                                 double sigma_s) {
  constexpr double kMinLonger = 1.2;  // than short ones: shorter sweeps would help little
  const bool longer = !has_rings(recording) && motor.median_sweep_s >= kMinLonger * kShortSweep_s;
  if (!longer || unseen_s < sigma_s / 2) return std::nullopt;
  return refusal(kLongSweeps, unseen_s / search_scale(motor).unit_s, motor.median_sweep_s, unseen_s * 1e3,
                 kShortSweep_s, unseen_of_short_sweeps_s(recording, motor, unseen_s) * 1e3);
}

MaybeRefusal smooth_motor_refusal(double sway_s, double sigma_s) {
  if (sway_s < sigma_s / 2) return std::nullopt;
  return refusal(kSmoothMotor, sway_s * 1e3, sway_s * 1e3);
}

MaybeRefusal drift_refusal(const Trend& trend, double duration_s, double sigma_s, std::string_view advice) {
  const double apart_s = std::abs(trend.slope) * duration_s,
               chance_s = kLimits.min_change_sigmas * trend.sigma * duration_s;
  if (apart_s < std::max({kLimits.max_change_s, kLimits.min_change_sigmas * sigma_s, chance_s}))
    return std::nullopt;
  return refusal(kClocksDrift, apart_s * 1e3, trend.slope * 1e6, trend.slope * duration_s * 1e3, duration_s,
                 advice);
}

MaybeRefusal sigma_refusal(std::optional<double> sigma_s, const SearchScale& scale) {
  if (!sigma_s) return refusal(kSigmaUnknown, {});
  if (*sigma_s < kLimits.max_sigma_units * scale.unit_s) return std::nullopt;
  return refusal(kSigmaTooLarge, *sigma_s / scale.unit_s, *sigma_s * 1e3);
}

}  // namespace sweepscope
