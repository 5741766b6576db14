#include "core/offset/judgement/unseen_sigma.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/numbers.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

// How much longer than short ones the sweeps are, as far as that matters.
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

bool is_2d(const Recording& recording) {
  return recording.directions.empty() && !has_rings(recording);
}

}  // namespace

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

double rests_sigma_s(const Recording& recording, const MotorMotion& motor) {
  if (recording.rig.motor.profile || !goes_in_steps(recording, motor)) return 0;
  const double steps = double(motor.sweeps.size()) * lines_a_sweep(recording, motor);
  return spacing(recording.motor.time_s, 1).median_s / std::sqrt(12 * steps);
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

double unseen_sigma_s(const Recording& recording, const MotorMotion& motor, double offset_s) {
  const double of_motor_and_lines_s =
      std::hypot(encoder_step_sigma_s(recording.motor, motor),
                 std::max(encoder_sampling_sigma_s(recording.motor, motor), rests_sigma_s(recording, motor)),
                 lines_sigma_s(motor, distinct_lines(recording, motor, offset_s)));
  const double of_beams_s = std::hypot(beam_times_sigma_s(recording), recording.report.profile_speed_sigma_s);
  return of_beams_s > 0 ? std::hypot(of_motor_and_lines_s, of_beams_s) : of_motor_and_lines_s;
}

double scans_a_sweep(const Recording& recording, const MotorMotion& motor) {
  const double period_s = median(spacings(scan_stamps_s(recording)));
  return period_s > 0 ? motor.median_sweep_s / period_s : 0;
}

double lines_a_sweep(const Recording& recording, const MotorMotion& motor) {
  const double spacing_rad = line_spacing_rad(recording, motor);
  return spacing_rad > 0 ? motor.median_speed_rad_s * motor.median_sweep_s / spacing_rad : 0;
}

bool has_sparse_sweeps(const Recording& recording, const MotorMotion& motor) {
  constexpr double kSparse = 12;
  return is_2d(recording) && lines_a_sweep(recording, motor) < kSparse;
}

bool has_few_lines(const Recording& recording, const MotorMotion& motor) {
  return is_2d(recording) && lines_a_sweep(recording, motor) < kLimits.min_lines_a_sweep;
}

bool sees_same_angles(const Recording& recording, const MotorMotion& motor, std::size_t sweeps) {
  const double scans = scans_a_sweep(recording, motor);
  if (!(scans > 0) || sweeps < 4 || scans > 60) return false;
  // Over all sweeps the angles shift by less than a quarter of a line's spacing.
  return std::abs(scans - std::round(scans)) * double(sweeps) < 0.25;
}

std::size_t sweeps_of_part(const MotorMotion& motor) {
  return std::size_t(10 / motor.median_sweep_s);
}

bool has_rings(const Recording& recording) {
  return std::any_of(recording.scans.begin(), recording.scans.end(),
                     [&](const LaserScan& scan) { return scan.ring != recording.scans.front().ring; });
}

double unseen_of_part_s(const Recording& recording, const MotorMotion& motor, std::size_t sweeps) {
  const bool same_angles = sees_same_angles(recording, motor, sweeps);
  return unseen_rad(longer_than_short(recording, motor), same_angles) / motor.median_speed_rad_s;
}

double unseen_of_short_sweeps_s(const Recording& recording, const MotorMotion& motor, double unseen_s) {
  const double longer = longer_than_short(recording, motor);
  const bool same_angles = sees_same_angles(recording, motor, sweeps_of_part(motor));
  // The motor would turn faster, too.
  return unseen_s * unseen_rad(1, same_angles) / unseen_rad(longer, same_angles) / longer;
}

}  // namespace sweepscope
