#include "core/simulation/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

enum SensorPurpose : std::uint64_t {
  kPhases = 2,
  kBeamNoise = 3,
  kEncoder = 4,
  kScanStamp = 5,
  kMotorStamp = 6,
  kWeakReturn = 8
};

constexpr double kMotorMargin_s = 0.3;  // the motor is recorded for this much longer, before and after

double phase_s(const SimulationOptions& options, std::uint64_t which, double period_s) {
  return Random(options.seed, kPhases, which).uniform() * period_s;
}

SpeedCourse course_of(const SimulationOptions& options) {
  SpeedCourse course{{}, options.speed_ramp, options.duration_s.value_or(0)};
  for (const double speed_dps : options.speeds_dps) course.speeds_radps.push_back(radians(speed_dps));
  return course;
}

Trajectory trajectory_of(const Scene& scene, std::uint64_t seed) {
  if (const WalkSpec* walk = std::get_if<WalkSpec>(&scene.motion)) return Trajectory(*walk, seed);
  if (const RecordedPath* path = std::get_if<RecordedPath>(&scene.motion))
    return Trajectory([path = *path](double t_s) { return path.at(t_s); });
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

/// Rz(yaw) Ry(pitch) Rx(roll), as a rig file's rpy_deg means it.
Eigen::Matrix3d rotation_of(const Vector3d& rpy_deg) {
  const SinCos r = sin_cos(radians(rpy_deg.x())), p = sin_cos(radians(rpy_deg.y())),
               y = sin_cos(radians(rpy_deg.z()));
  Eigen::Matrix3d rotation;
  rotation << y.cos * p.cos, y.cos * p.sin * r.sin - y.sin * r.cos, y.cos * p.sin * r.cos + y.sin * r.sin,
      y.sin * p.cos, y.sin * p.sin * r.sin + y.cos * r.cos, y.sin * p.sin * r.cos - y.cos * r.sin,  //
      -p.sin, p.cos * r.sin, p.cos * r.cos;
  return rotation;
}

}  // namespace

Sensor::Sensor(const SimulationOptions& options, const Scene& scene)
    : options_(options),
      caster_(scene.mesh),
      trajectory_(trajectory_of(scene, options.seed)),
      motor_(options.motor, options.sweep_s, phase_s(options, 0, 2 * options.sweep_s),
             {options.uneven_motor, options.seed}, course_of(options), radians(options.swing_deg),
             {options.motor_rest_at_s, options.motor_rest_at_s + options.motor_rest_s},
             {step_s(options), options.dwell_s}),
      encoder_phase_s_(phase_s(options, 1, 1 / options.encoder_hz)),
      glass_(options.glass, options.seed) {
  const Eigen::Matrix3d motor_from_laser = rotation_of(laser_in_motor_rpy_deg(options));
  for (std::uint32_t ray = 0; ray < options.scanner.rays(); ++ray)
    ray_directions_.emplace_back(motor_from_laser * direction(ray));
}

Vector3d Sensor::direction(std::uint32_t ray) const {
  const Scanner& scanner = options_.scanner;
  const std::uint32_t ring = ray % scanner.rings;
  const SinCos angle = sin_cos(angle_rad(array_index(ray / scanner.rings)));
  const SinCos up = sin_cos(radians(scanner.lowest_ring_deg + scanner.ring_step_deg * ring));
  return {up.cos * angle.cos, up.cos * angle.sin, up.sin};
}

double Sensor::angle_rad(std::uint32_t array_index) const {
  const Scanner& scanner = options_.scanner;
  return radians(scanner.angle_min_deg + scanner.angle_increment_deg * static_cast<double>(array_index));
}

std::uint32_t Sensor::array_index(std::uint32_t beam) const {
  return fired_times(options_) == BeamTimes::kReversed ? options_.scanner.beams - 1 - beam : beam;
}

std::uint32_t Sensor::first_beam(std::uint32_t part) const {
  return static_cast<std::uint32_t>(std::uint64_t{options_.scanner.beams} * part / options_.parts);
}

std::uint32_t Sensor::part_of(std::uint32_t beam) const {
  auto part = static_cast<std::uint32_t>(std::uint64_t{beam} * options_.parts / options_.scanner.beams);
  while (first_beam(part + 1) <= beam) ++part;
  return part;
}

double Sensor::fired_s(std::uint32_t ray) const {
  const Scanner& scanner = options_.scanner;
  const std::uint32_t beam = ray / scanner.rings, ring = ray % scanner.rings, half = scanner.rings / 2;
  const std::uint32_t before = ring < half ? 2 * ring : 2 * (ring - half) + 1;  // rings of the same beam
  const bool instant = fired_times(options_) == BeamTimes::kInstant;
  const double beam_s = (instant ? first_beam(part_of(beam)) : beam) * scanner.increment_s();
  return scanner.is_3d() ? beam_s + before * scanner.ring_interval_s : beam_s;
}

LaserScan Sensor::scan(std::size_t turn, std::uint32_t part) const {
  const Scanner& scanner = options_.scanner;
  const std::uint32_t begin = first_beam(part), end = first_beam(part + 1);
  const BeamTimes times = fired_times(options_);
  const double late_s =
      options_.stamp_jitter_s * Random(options_.seed, kScanStamp, turn * options_.parts + part).normal();
  const double first_s = static_cast<double>(turn) * scanner.scan_period_s + fired_s(begin);
  LaserScan scan;
  scan.first_beam_s = whole_ns(std::max(0.0, first_s + late_s));
  scan.time_increment_s = times == BeamTimes::kInstant ? 0 : scanner.increment_s();
  scan.angle_min_rad = static_cast<float>(angle_rad(array_index(begin)));
  scan.angle_increment_rad = static_cast<float>(radians(scanner.angle_increment_deg));
  if (times == BeamTimes::kReversed) scan.angle_increment_rad = -scan.angle_increment_rad;
  scan.first_range = begin;
  scan.beams = end - begin;
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

Vector3d Sensor::from_motor(const Pose& pose, double t_s, const Vector3d& in_motor) const {
  const SinCos turned = sin_cos(radians(options_.motor_middle_deg) +
                                motor_.laser_angle_rad(t_s, radians(options_.backlash_deg)));
  const int about = index_of(options_.axis);
  const double cosine = turned.cos, sine = is_negative(options_.axis) ? -turned.sin : turned.sin;
  const int from = (about + 1) % 3, to = (about + 2) % 3;
  Vector3d in_base = in_motor;
  in_base[from] = in_motor[from] * cosine - in_motor[to] * sine;
  in_base[to] = in_motor[from] * sine + in_motor[to] * cosine;
  return pose.orientation * in_base;
}

Vector3d Sensor::laser_position_at(double t_s) const {
  const Pose pose = pose_at(t_s);
  return pose.position_m + from_motor(pose, t_s, options_.mount_error_m);
}

Sensor::Return Sensor::fire(std::size_t turn, std::uint32_t ray, float& intensity) const {
  const Scanner& scanner = options_.scanner;
  const double t_s = static_cast<double>(turn) * scanner.scan_period_s + fired_s(ray);
  const Pose pose = pose_at(t_s);
  const Vector3d origin = pose.position_m + from_motor(pose, t_s, options_.mount_error_m);
  const Vector3d direction = from_motor(pose, t_s, ray_directions_[ray]).normalized();
  auto [hit, end_m] =
      glass_.cast(caster_, origin, direction, scanner.range_max_m, turn * scanner.rays() + ray);
  for (const Person& person : people_) {
    const auto body = person.cast(origin, direction, t_s);
    if (!body || body->range_m >= end_m) continue;
    hit = body;
    end_m = body->range_m;
  }
  intensity = hit ? intensity_of(*hit) : 0;
  if (!hit) return {};
  return {hit->range_m + options_.grazing_bias_m * (1 - hit->cos_incidence),
          options_.grazing_dropout * std::max(0.0, 1 - 2 * hit->albedo * hit->cos_incidence)};
}

void Sensor::cast_turn(std::size_t turn, std::span<float> ranges_m, std::span<float> intensities) const {
  const Scanner& scanner = options_.scanner;
  const double constant_noise_m = options_.noise_m.value_or(scanner.noise_m);
  const double noise_per_m = options_.noise_per_m + (options_.noise_m ? 0 : scanner.noise_per_m);
  Random random(options_.seed, kBeamNoise, turn), weak(options_.seed, kWeakReturn, turn);
  std::vector<Return> met(scanner.rays());
  for (std::uint32_t ray = 0; ray < scanner.rays(); ++ray) met[ray] = fire(turn, ray, intensities[ray]);
  for (std::uint32_t ray = 0; ray < scanner.rays(); ++ray) {
    // Drawn whatever the beam met, so that one option does not change the luck of another.
    const double luck = random.normal();
    const bool dropped = random.uniform() < options_.dropout, lost = weak.uniform() < met[ray].lost;
    const double mixed = random.uniform(), between = random.uniform();
    double range_m = met[ray].range_m;
    const double beside_m = met[ray + scanner.rings < scanner.rays() ? ray + scanner.rings : ray].range_m;
    if (mixed < options_.mixed_pixels && std::isfinite(beside_m) && std::abs(beside_m - range_m) > 0.2)
      range_m += between * (beside_m - range_m);
    // Nothing is NaN from here on, and not usable.
    const double noise_m = (constant_noise_m + noise_per_m * range_m) * luck;
    const double whole_mm = std::floor((range_m + noise_m) * 1e3 + 0.5);
    const bool usable =
        !dropped && !lost && whole_mm >= scanner.range_min_m * 1e3 && whole_mm <= scanner.range_max_m * 1e3;
    ranges_m[ray] = usable ? static_cast<float>(whole_mm / 1e3) : std::numeric_limits<float>::quiet_NaN();
    if (!usable) intensities[ray] = 0;
  }
}

double Sensor::encoder_angle_rad(double t_s) const {
  const double angle_rad = radians(options_.motor_middle_deg) + motor_.angle_rad(t_s);
  return angle_rad + radians(options_.eccentricity_deg) *
                         sin_cos(angle_rad + radians(options_.eccentricity_phase_deg)).sin;
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
    const double jumped_s = true_s < options_.jump_at_s ? 0 : options_.jump_s;
    const double stamp_s =
        true_s * (1 + options_.clock_drift_ppm * 1e-6) + options_.offset_s + jumped_s + late_s;
    const double angle_rad = encoder_angle_rad(true_s);
    samples.emplace_back(whole_ns(stamp_s), std::floor(angle_rad / step_rad + 0.5) * step_rad);
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
