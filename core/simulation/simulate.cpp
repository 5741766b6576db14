#include "core/simulation/simulate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/simulation/clouds.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/meshes/ray_caster.hpp"
#include "core/simulation/motion/trajectory.hpp"
#include "core/simulation/own_scene.hpp"
#include "core/simulation/scenes/free_space.hpp"
#include "core/simulation/scenes/people.hpp"
#include "core/simulation/scenes/scene.hpp"
#include "core/simulation/sensor.hpp"
#include "core/simulation/worlds/walk.hpp"
#include "core/simulation/worlds/world.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope {
namespace {

using namespace simulation;

constexpr std::int64_t kEpoch_ns = 1'489'900'000'000'000'000;
constexpr double kRoomDuration_s = 4.5;
constexpr double kLongestStand_s = 7200;
constexpr std::uint64_t kGyroPurpose = 12;
constexpr double kTruthStep_s = 0.01, kOwnTruthStep_s = 0.005;

tl::unexpected<Error> wrong(std::string sentence) {
  return failure(ExitCode::kWrongUsage, std::move(sentence));
}

struct Bound {
  const char* name;
  double value, least, most;
  const char* unit;
};

std::vector<Bound> bounds_of(const SimulationOptions& o) {
  const Vector3d at_m = o.own.placement.at_m.value_or(Vector3d::Zero());
  return {
      {"the offset", o.offset_s * 1e3, -10e3, 10e3, " ms"},
      {"the noise", o.noise_m.value_or(0) * 1e3, 0, 1000, " mm"},
      {"the dropout", o.dropout, 0, 1, ""},
      {"the sweep", o.sweep_s, 0.05, 60, " s"},
      {"the middle of the motor's swing", o.motor_middle_deg, -180, 180, " deg"},
      {"the motor's swing", o.swing_deg, 1, 180, " deg"},
      {"the factor of scan_time", o.scan_time_factor, 0, 100, ""},
      {"the number of parts of a turn", double(o.parts), 1, std::min(100.0, double(o.scanner.beams)), ""},
      {"the number of repeats of a motor angle", double(o.motor_repeats), 1, 100, ""},
      {"the encoder's step", o.encoder_step_deg, 1e-6, 10, " deg"},
      {"the encoder's rate", o.encoder_hz, 5, 2000, " Hz"},
      {"the encoder's jitter", o.encoder_jitter_s * 1e3, 0, 300 / o.encoder_hz, " ms"},
      {"the fraction of mixed pixels", o.mixed_pixels, 0, 1, ""},
      {"the grazing bias", o.grazing_bias_m * 1e3, -500, 500, " mm"},
      {"the stamp jitter", o.stamp_jitter_s * 1e3, 0, 10, " ms"},
      {"the backlash", o.backlash_deg, 0, 10, " deg"},
      {"the clock drift", o.clock_drift_ppm, -1000, 1000, " ppm"},
      {"the number of steps per turn", o.steps_per_turn, 0, 1e4, ""},
      {"the rest before a step", o.dwell_s, 0, 60, " s"},
      {"the motor's rest", o.motor_rest_s, 0, 1e6, " s"},
      {"the time of the motor's rest", o.motor_rest_at_s, 0, 1e6, " s"},
      {"the jump", o.jump_s * 1e3, -10e3, 10e3, " ms"},
      {"the time of the jump", o.jump_at_s, 0, 1e6, " s"},
      {"the nudge", o.nudge_m * 1e3, -1000, 1000, " mm"},
      {"the IMU's shift", o.imu_shift_s * 1e3, -10e3, 10e3, " ms"},
      {"the noise per metre", o.noise_per_m * 1e3, 0, 100, " mm"},
      {"the grazing dropout", o.grazing_dropout, 0, 1, ""},
      {"the mount's roll error", o.mount_error_deg.x(), -10, 10, " deg"},
      {"the mount's pitch error", o.mount_error_deg.y(), -10, 10, " deg"},
      {"the mount's yaw error", o.mount_error_deg.z(), -10, 10, " deg"},
      {"the mount's error along x", o.mount_error_m.x() * 1e3, -500, 500, " mm"},
      {"the mount's error along y", o.mount_error_m.y() * 1e3, -500, 500, " mm"},
      {"the mount's error along z", o.mount_error_m.z() * 1e3, -500, 500, " mm"},
      {"the encoder's eccentricity", o.eccentricity_deg, 0, 10, " deg"},
      {"the phase of the eccentricity", o.eccentricity_phase_deg, -360, 360, " deg"},
      {"the unevenness of the motor", o.uneven_motor, 0, 0.5, ""},
      {"the number of people", static_cast<double>(o.people), 0, 50, ""},
      {"the fraction of glass", o.glass, 0, 1, ""},
      {"the trajectory's scale", o.own.placement.scale, 0, 100, ""},
      {"the trajectory's place, x", at_m.x(), -5000, 5000, " m"},
      {"the trajectory's place, y", at_m.y(), -5000, 5000, " m"},
      {"the trajectory's place, z", at_m.z(), -5000, 5000, " m"},
      {"the trajectory's yaw", o.own.placement.yaw_deg, -360, 360, " deg"},
      {"the trajectory's start", o.own.from_s, 0, 1e6, " s"},
      {"the trajectory's smoothing", o.own.placement.smoothing_s * 1e3, 10, 1000, " ms"},
  };
}

Result<void> check(const SimulationOptions& o) {
  for (const double speed_dps : o.speeds_dps)
    if (!(speed_dps >= 1 && speed_dps <= 3600))
      return wrong(fmt::format("a speed of the motor is {:g} deg/s, but must lie between 1 and 3600 deg/s",
                               speed_dps));
  if (o.motor_messages == MotorMessages::kIndex && o.motor != MotorKind::kOneWay)
    return wrong("an index marks the turns of a motor that turns one way: use it with --motor one-way");
  if (!o.speeds_dps.empty() && o.motor != MotorKind::kOneWay)
    return wrong("speeds are those of a motor that turns one way: use it with --motor one-way");
  if (o.steps_per_turn > 0 && !o.speeds_dps.empty())
    return wrong("steps are those of a motor with one speed, half a turn or a swing in --sweep-s");
  if (o.steps_per_turn > 0 && !(o.dwell_s < step_s(o)))
    return wrong(fmt::format("a rest of {:g} s leaves no time for a step, which takes {:g} s in all",
                             o.dwell_s, step_s(o)));
  if (o.stamp_at == StampAt::kArrival) return wrong("a simulated scan is stamped at its first or last beam");
  if (o.scanner.is_3d() && (o.parts > 1 || o.beam_times || o.no_time_increment || o.scan_time_factor != 1 ||
                            o.stamp_at != StampAt::kFirstBeam))
    return wrong(
        fmt::format("{} writes clouds: how a LaserScan is written can't be chosen for it", o.scanner.name));
  if (o.speed_ramp && o.speeds_dps.size() < 2) return wrong("a ramp needs at least two speeds");
  for (const Bound& b : bounds_of(o))
    if (!(b.value >= b.least && b.value <= b.most))
      return wrong(fmt::format("{} is {:g}{}, but must lie between {:g} and {:g}{}", b.name, b.value, b.unit,
                               b.least, b.most, b.unit));
  return {};
}

/// How long the scene's motion takes; a rig that stands has no end of its own.
std::optional<double> motion_s(const Scene& scene) {
  if (const WalkSpec* walk = std::get_if<WalkSpec>(&scene.motion)) return walk->duration_s;
  if (const RecordedPath* path = std::get_if<RecordedPath>(&scene.motion)) return path->duration_s;
  return std::nullopt;
}

/// The duration asked for, or the scene's own.
Result<double> duration_of(const SimulationOptions& options, const Scene& scene) {
  const double longest_s = motion_s(scene).value_or(kLongestStand_s);
  const double duration_s = options.duration_s.value_or(motion_s(scene).value_or(kRoomDuration_s));
  if (!(duration_s >= 0.1 && duration_s <= longest_s))
    return wrong(fmt::format("the duration is {:g} s, but {} can be recorded for 0.1 to {:g} s", duration_s,
                             options.scene, longest_s));
  return duration_s;
}

/// A world's mesh, and what moves through it or stands in it.
template <typename Motion>
Result<Scene> scene_in(World& world, std::optional<Motion> motion, const std::string& name) {
  if (!motion) return wrong(name + ": no free way or place was found; use another seed");
  return Scene{std::move(world.mesh), std::move(*motion)};
}

/// A world drawn at random, with a walk of the duration asked for or a rig that stands.
Result<Scene> random_scene_of(SimulationOptions& options) {
  constexpr double kWalk_s = 60, kShortest_s = 5, kLongest_s = 600;
  const RandomWorld& random = options.random;
  const bool stands = random.walk == kStanding;
  const double duration_s = options.duration_s.value_or(kWalk_s);
  if (!stands && !(duration_s >= kShortest_s && duration_s <= kLongest_s))
    return wrong(fmt::format("the duration is {:g} s, but walks through random worlds last {:g} to {:g} s",
                             duration_s, kShortest_s, kLongest_s));
  const auto style = walk_style(random.walk);
  if (!stands && !style)
    return wrong(
        fmt::format("there is no walk '{}'; the walks are {}", random.walk, fmt::join(walk_names(), ", ")));
  auto world = make_world(random.world, random.world_seed);
  if (!world)
    return wrong(fmt::format("there is no world '{}'; the worlds are {}", random.world,
                             fmt::join(world_names(), ", ")));
  options.scene = fmt::format("{}:{} {}:{}", random.world, random.world_seed, random.walk, random.walk_seed);
  if (stands) return scene_in(*world, make_stand(*world, random.walk_seed), options.scene);
  return scene_in(*world, make_walk(*world, *style, random.walk_seed, duration_s), options.scene);
}

/// The scene asked for; fills in what the simulation says about an own one.
Result<Scene> scene_of(Simulation& simulation) {
  SimulationOptions& options = simulation.options;
  if (!options.random.world.empty()) return random_scene_of(options);
  if (options.own.mesh.empty()) {
    auto scene = make_scene(options.scene);
    if (!scene)
      return wrong(fmt::format("there is no scene '{}'; the scenes are {}", options.scene,
                               fmt::join(scene_names(), ", ")));
    return std::move(*scene);
  }
  options.scene = options.own.mesh.filename().string();
  auto own = load_own_scene(options.own);
  if (!own) return tl::unexpected(own.error());
  simulation.mesh_hash = own->mesh_hash;
  simulation.trajectory_hash = own->trajectory_hash;
  if (const RecordedPath* path = std::get_if<RecordedPath>(&own->scene.motion))
    simulation.deviation = path->deviation;
  return std::move(own->scene);
}

bool has_named_scene(const SimulationOptions& options) {
  return options.own.mesh.empty() && options.random.world.empty();
}

/// Brings the people in, and keeps an own walk out of the walls.
Result<void> furnish(Sensor& sensor, const SimulationOptions& options) {
  const auto laser_at = [&](double t_s) { return sensor.laser_position_at(t_s); };
  const double duration_s = *options.duration_s;
  if (!has_named_scene(options))
    if (auto free = check_free_space(sensor.surroundings(), laser_at, duration_s); !free)
      return wrong(fmt::format("{}: {}", options.scene, free.error().message));
  auto people = place_people(options.people, options.seed, sensor.surroundings(), laser_at, duration_s);
  if (!people) return tl::unexpected(people.error());
  sensor.set_people(std::move(*people));
  return {};
}

/// Casts all beams into the recording; false where the job was cancelled.
bool cast_turns(const Sensor& sensor, std::size_t rays, Recording& recording, const Job& job) {
  const std::size_t turns = recording.ranges_m.size() / rays;
  std::atomic<std::size_t> done{0};
  std::atomic<bool> stopped{false};
  for_each_index(turns, [&](std::size_t i) {
    if (stopped || job.cancelled()) {
      stopped = true;
      return;
    }
    const std::size_t first = i * rays;
    sensor.cast_turn(i, {recording.ranges_m.data() + first, rays},
                     {recording.intensities.data() + first, rays});
    const std::size_t finished = ++done;
    if (finished % 64 == 0) job.report("casting", static_cast<double>(finished) / static_cast<double>(turns));
  });
  return !stopped;
}

Recording blank_recording(const SimulationOptions& options, const Sensor& sensor, double duration_s) {
  Recording recording;
  recording.name = options.scene;
  recording.epoch_ns = kEpoch_ns;
  recording.rig = rig_of(options);
  const std::size_t rays = options.scanner.rays();
  const auto turns = static_cast<std::size_t>(std::floor(duration_s / options.scanner.scan_period_s + 1e-9));
  for (std::size_t turn = 0; turn < turns; ++turn) {
    for (std::uint32_t part = 0; part < options.parts; ++part) {
      LaserScan scan = sensor.scan(turn, part);
      scan.first_range += turn * rays;
      recording.scans.push_back(scan);
    }
  }
  recording.ranges_m.resize(turns * rays);
  recording.intensities.resize(turns * rays);
  recording.motor = sensor.motor_track(duration_s);
  return recording;
}

/// The scans of a 3D scanner are what its clouds are read as.
Result<void> read_own_clouds(Simulation& simulation, const Sensor& sensor) {
  RawRecording messages;
  messages.file = messages.name = simulation.recording.name;
  messages.lasers.push_back(clouds_of(simulation, sensor));
  messages.joints.push_back(raw_joint(simulation));
  auto clouds = std::exchange(messages.lasers.front().clouds, {});  // not copied with the lines
  auto recording = assemble(messages, simulation.recording.rig, std::nullopt);
  if (!recording) return tl::unexpected(recording.error());
  messages.lasers.front().clouds = std::move(clouds);
  simulation.recording = std::move(*recording);
  simulation.messages = std::make_shared<const RawRecording>(std::move(messages));
  return {};
}

void fill_truth(Simulation& simulation, const Sensor& sensor) {
  const double end_s = *simulation.options.duration_s;
  const double step_s = has_named_scene(simulation.options) ? kTruthStep_s : kOwnTruthStep_s;
  const auto steps = static_cast<int>(std::floor(end_s / step_s + 1e-9));
  for (int i = 0; i <= steps; ++i) {
    const simulation::Pose pose = sensor.pose_at(i * step_s);
    simulation.truth.push_back({i * step_s, pose.position_m, pose.orientation});
  }
  const WalkMeasure measured = measure([&](double t_s) { return sensor.pose_at(t_s); }, 0, end_s);
  simulation.length_m = measured.length_m;
  simulation.top_speed_mps = measured.top_speed_mps;
  simulation.top_angular_rate_radps = measured.top_angular_rate_radps;
}

// A gyroscope of a phone's or a robot's class, fixed to the base. Its clock starts with the laser's.
void fill_imu(Simulation& simulation, const Sensor& sensor) {
  constexpr double kRate_hz = 200, kNoise_rad_s = 0.005, kHalf_s = 1e-3;
  const Vector3d bias_rad_s(0.01, -0.02, 0.005);
  const SimulationOptions& options = simulation.options;
  const auto samples = static_cast<std::uint64_t>(*options.duration_s * kRate_hz);
  for (std::uint64_t i = 0; i <= samples; ++i) {
    const double t_s = double(i) / kRate_hz;
    const double from_s = std::max(0.0, t_s - kHalf_s), to_s = std::min(*options.duration_s, t_s + kHalf_s);
    const Eigen::Quaterniond turn =
        sensor.pose_at(from_s).orientation.conjugate() * sensor.pose_at(to_s).orientation;
    // Of so small an angle twice the vector part is the rotation vector, to 1e-9.
    const Vector3d rate_rad_s = (turn.w() < 0 ? -2 : 2) * turn.vec() / (to_s - from_s);
    Random random(options.seed, kGyroPurpose, i);
    Vector3d noise;
    for (double& part : noise) part = kNoise_rad_s * random.normal();
    simulation.imu.time_s.push_back(t_s - options.imu_shift_s);
    simulation.imu.rate_rad_s.emplace_back(rate_rad_s + bias_rad_s + noise);
  }
}

}  // namespace

std::string_view name_of(MotorMessages messages) {
  constexpr std::array<std::string_view, 3> kNames{"joint-states", "index", "none"};
  return kNames[static_cast<std::size_t>(messages)];
}

Eigen::Vector3d laser_in_motor_rpy_deg(const SimulationOptions& options) {
  const double roll_deg = (index_of(options.axis) == 2 ? 90 : 0) + (options.laser_upside_down ? 180 : 0);
  return options.mount_error_deg + roll_deg * Vector3d::UnitX();
}

double step_s(const SimulationOptions& options) {
  if (!(options.steps_per_turn > 0)) return 0;
  const double half_turns = options.motor == MotorKind::kOneWay ? 1 : options.swing_deg / 90;
  return 2 * options.sweep_s / (half_turns * options.steps_per_turn);
}

// The motion that the motor is commanded to make; of a sine that of even accelerations.
MotorProfile profile_of(const SimulationOptions& options) {
  MotorProfile profile;
  profile.steps_per_turn = options.steps_per_turn;
  profile.dwell_s = options.dwell_s;
  if (options.motor == MotorKind::kOneWay) {
    const double dps = options.speeds_dps.empty() ? 180 / options.sweep_s : options.speeds_dps.front();
    profile.turns_per_s = dps / 360;
    return profile;
  }
  profile.between = MotorProfile::Limits{options.motor_middle_deg - options.swing_deg,
                                         options.motor_middle_deg + options.swing_deg};
  profile.turns_per_s = options.swing_deg / 180 / options.sweep_s;
  if (options.motor == MotorKind::kTrapezoid)
    profile.ramp_s = simulation::kReversalOfSweep / 2 * options.sweep_s;
  if (options.motor == MotorKind::kSine) profile.ramp_s = options.sweep_s / 2;
  return profile;
}

Rig rig_of(const SimulationOptions& options) {
  Rig rig;
  const double increment_s = options.scanner.increment_s();
  if (fired_times(options) == BeamTimes::kInstant)
    rig.laser.time_increment_s = 0;
  else if (fired_times(options) == BeamTimes::kReversed)
    rig.laser.time_increment_s = -increment_s;
  else if (options.no_time_increment)
    rig.laser.time_increment_s = increment_s;
  rig.laser.stamp_at = options.stamp_at;
  if (options.motor_in_degrees) rig.motor.scale = radians(1);
  if (options.motor_messages == MotorMessages::kNone) rig.motor.profile = profile_of(options);
  if (options.motor_messages == MotorMessages::kIndex) {
    rig.motor.index = true;
    rig.motor.topic = "/index";
  }
  rig.mount.axis = (is_negative(options.axis) ? -1 : 1) * Vector3d::Unit(index_of(options.axis));
  rig.mount.laser_in_motor_rpy_deg = laser_in_motor_rpy_deg(options) - options.mount_error_deg;
  return rig;
}

Result<Simulation> simulate(const SimulationOptions& options, const Job& job) {
  if (auto checked = check(options); !checked) return tl::unexpected(checked.error());
  Simulation simulation;
  simulation.options = options;
  const Result<Scene> scene = scene_of(simulation);
  if (!scene) return tl::unexpected(scene.error());
  const Result<double> duration_s = duration_of(simulation.options, *scene);
  if (!duration_s) return tl::unexpected(duration_s.error());
  simulation.options.duration_s = *duration_s;
  simulation.moving = motion_s(*scene).has_value();
  simulation.triangles = scene->mesh.triangles.size();
  Sensor sensor(simulation.options, *scene);
  if (auto furnished = furnish(sensor, simulation.options); !furnished)
    return tl::unexpected(furnished.error());
  simulation.recording = blank_recording(simulation.options, sensor, *duration_s);
  if (!cast_turns(sensor, simulation.options.scanner.rays(), simulation.recording, job))
    return failure(ExitCode::kInterrupted, "interrupted");
  if (options.scanner.is_3d())
    if (auto read = read_own_clouds(simulation, sensor); !read) return tl::unexpected(read.error());
  fill_truth(simulation, sensor);
  if (simulation.options.imu) fill_imu(simulation, sensor);
  return simulation;
}

}  // namespace sweepscope
