#include "core/simulation/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/simulation/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

enum Purpose : std::uint64_t { kPhases = 2, kBeamNoise = 3, kEncoder = 4, kScanStamp = 5, kMotorStamp = 6 };

constexpr double kMotorMargin_s = 0.3;  // the motor is recorded for this much longer, before and after

double phase_s(const SimulationOptions& options, std::uint64_t which, double period_s) {
  return Random(options.seed, kPhases, which).uniform() * period_s;
}

Trajectory trajectory_of(const Scene& scene, std::uint64_t seed) {
  if (const WalkSpec* walk = std::get_if<WalkSpec>(&scene.motion)) return Trajectory(*walk, seed);
  return Trajectory(std::get<Stand>(scene.motion));
}

/// As a message's stamp keeps it.
double whole_ns(double t_s) {
  return std::floor(t_s * 1e9 + 0.5) * 1e-9;
}

/// Rises with brightness and squareness, falls with range; of the size the UTM-30LX reports.
float intensity_of(const Hit& hit) {
  const double far = hit.range_m / 12;
  return static_cast<float>(
      std::floor(4000 * hit.albedo * (0.25 + 0.75 * hit.cos_incidence) / (1 + far * far)));
}

}  // namespace

Sensor::Sensor(const SimulationOptions& options, const Scene& scene)
    : options_(options),
      caster_(scene.mesh),
      trajectory_(trajectory_of(scene, options.seed)),
      motor_(options.motor, options.sweep_s, phase_s(options, 0, 2 * options.sweep_s)),
      encoder_phase_s_(phase_s(options, 1, 1 / options.encoder_hz)) {
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const SinCos angle = sin_cos(radians(-90 + 0.25 * static_cast<double>(beam)));
    beam_directions_.emplace_back(angle.cos, angle.sin);
  }
}

LaserScan Sensor::scan(std::size_t number) const {
  LaserScan scan;
  const double late_s = options_.stamp_jitter_s * Random(options_.seed, kScanStamp, number).normal();
  scan.first_beam_s = whole_ns(std::max(0.0, static_cast<double>(number) * kScanPeriod_s + late_s));
  scan.time_increment_s = kTimeIncrement_s;
  scan.angle_min_rad = kAngleMin_rad;
  scan.angle_increment_rad = kAngleIncrement_rad;
  scan.beams = kBeams;
  return scan;
}

Pose Sensor::pose_at(double t_s) const {
  Pose pose = trajectory_.at(t_s);
  if (options_.nudge_m != 0) {
    const double push = smooth_step((t_s - 1.0) / 0.5) * options_.nudge_m;
    pose.position_m += push * Vector3d::UnitY();
  }
  return pose;
}

Vector3d Sensor::direction_in_world(const Pose& pose, double t_s, std::size_t beam) const {
  const SinCos roll = sin_cos(motor_.laser_angle_rad(t_s, radians(options_.backlash_deg)));
  const Vector2d& in_laser = beam_directions_[beam];
  const Vector3d in_base(in_laser.x(), in_laser.y() * roll.cos, in_laser.y() * roll.sin);
  return (pose.orientation * in_base).normalized();
}

void Sensor::cast_scan(std::size_t number, std::span<float> ranges_m, std::span<float> intensities) const {
  Random random(options_.seed, kBeamNoise, number);
  std::vector<double> met_m(kBeams, std::numeric_limits<double>::infinity());
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const double t_s =
        static_cast<double>(number) * kScanPeriod_s + static_cast<double>(beam) * kTimeIncrement_s;
    const Pose pose = pose_at(t_s);
    intensities[beam] = 0;
    const auto hit = caster_.cast(pose.position_m, direction_in_world(pose, t_s, beam), kRangeMax_m);
    if (!hit) continue;
    met_m[beam] = hit->range_m + options_.grazing_bias_m * (1 - hit->cos_incidence);
    intensities[beam] = intensity_of(*hit);
  }
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    // Drawn whatever the beam met, so that one option does not change the luck of another.
    const double noise_m = options_.noise_m * random.normal();
    const bool dropped = random.uniform() < options_.dropout;
    const double mixed = random.uniform(), between = random.uniform();
    double range_m = met_m[beam];
    const double beside_m = met_m[std::min(beam + 1, kBeams - 1)];
    if (mixed < options_.mixed_pixels && std::isfinite(beside_m) && std::abs(beside_m - range_m) > 0.2)
      range_m += between * (beside_m - range_m);
    const double whole_mm = std::floor((range_m + noise_m) * 1e3 + 0.5);
    const bool usable = !dropped && whole_mm >= kRangeMin_m * 1e3 && whole_mm <= kRangeMax_m * 1e3;
    ranges_m[beam] = usable ? static_cast<float>(whole_mm / 1e3) : std::numeric_limits<float>::quiet_NaN();
    if (!usable) intensities[beam] = 0;
  }
}

MotorTrack Sensor::motor_track(double duration_s) const {
  std::vector<std::pair<double, double>> samples;  // stamp, angle
  const double period_s = 1 / options_.encoder_hz, step_rad = radians(options_.encoder_step_deg);
  const auto before = static_cast<std::int64_t>(std::ceil(kMotorMargin_s * options_.encoder_hz));
  const auto after =
      static_cast<std::int64_t>(std::ceil((duration_s + kMotorMargin_s) * options_.encoder_hz));
  for (std::int64_t i = -before; i <= after; ++i) {
    const auto number = static_cast<std::uint64_t>(i + before);
    const double off_s = options_.encoder_jitter_s * Random(options_.seed, kEncoder, number).normal();
    const double true_s = static_cast<double>(i) * period_s + encoder_phase_s_ +
                          std::clamp(off_s, -0.45 * period_s, 0.45 * period_s);
    const double late_s = options_.stamp_jitter_s * Random(options_.seed, kMotorStamp, number).normal();
    const double stamp_s = true_s * (1 + options_.clock_drift_ppm * 1e-6) + options_.offset_s + late_s;
    samples.emplace_back(whole_ns(stamp_s), std::floor(motor_.angle_rad(true_s) / step_rad + 0.5) * step_rad);
  }
  // As reading does with stamps out of order. Leaving those out that come too late would keep the late stamps
  // rather than the early ones, and so shift the offset.
  std::sort(samples.begin(), samples.end());
  MotorTrack track;
  for (const auto& [stamp_s, angle_rad] : samples) {
    if (!track.time_s.empty() && stamp_s <= track.time_s.back()) continue;
    track.time_s.push_back(stamp_s);
    track.angle_rad.push_back(angle_rad);
  }
  return track;
}

}  // namespace sweepscope::simulation
