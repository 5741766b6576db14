#include "core/simulation/typed_simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/io/text_cursor.hpp"
#include "core/simulation/worlds/walk.hpp"
#include "core/simulation/worlds/world.hpp"

namespace sweepscope {
namespace {

using Group = SimulationOption::Group;

/// "1,-2,0.5"; none for another text.
std::optional<Eigen::Vector3d> triple(std::string_view text) {
  Eigen::Vector3d values;
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = std::min(text.find(','), text.size());
    if ((i < 2) == (end == text.size())) return std::nullopt;
    TextCursor words(text.substr(0, end));
    const auto number = words.next_number();
    if (!number || words.next_word() || !std::isfinite(*number)) return std::nullopt;
    values[i] = *number;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return values;
}

tl::unexpected<Error> not_a_triple(const char* option, const std::string& text) {
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{} needs three numbers separated by commas, not '{}'", option, text));
}

std::optional<MotorMessages> motor_messages(std::string_view name) {
  for (const MotorMessages messages :
       {MotorMessages::kJointStates, MotorMessages::kIndex, MotorMessages::kNone})
    if (name_of(messages) == name) return messages;
  return std::nullopt;
}

std::vector<SimulationOption> recording_options(TypedSimulation& typed) {
  SimulationOptions& options = typed.options;
  return {
      {"offset-ms", &typed.offset_ms, "t_motor = t_laser + offset"},
      {"seed", &options.seed, "Random seed; the same seed gives the same file"},
      {"duration-s", &options.duration_s,
       "Length of the recording (default: the whole walk, 4.5 s in a room)", "", "", false},
      {"noise-mm", &typed.noise_mm,
       "Standard deviation of the range noise (default: the scanner's, 10 for a UTM-30LX)", "", "", false},
      {"dropout", &options.dropout, "Fraction of beams without a return"},
      {"scanner", &typed.scanner,
       fmt::format("The scanner, as its driver writes it: {}", fmt::join(simulation::scanner_names(), ", "))},
      {"laser-upside-down", &options.laser_upside_down, "Mount the scanner upside down"},
      {"sweep-s", &options.sweep_s, "Duration of one sweep of the motor, from reversal to reversal"},
      {"motor", &typed.motor, "triangle, trapezoid, sine, one-way or stuck"},
      {"axis", &typed.axis, "The axis that the motor turns about: x rolls, y tilts, z yaws; also -x, -y, -z"},
      {"swing-deg", &options.swing_deg, "Angle by which the motor swings to either side"},
      {"motor-middle-deg", &options.motor_middle_deg,
       "Angle about which the motor swings; the scanner is level at 0"},
      {"motor-rest-s", &options.motor_rest_s, "How long the motor stands still, from --motor-rest-at-s on"},
      {"motor-rest-at-s", &options.motor_rest_at_s, "Seconds since the first scan"},
      {"steps-per-turn", &options.steps_per_turn, "Move the motor in steps; 0: evenly"},
      {"dwell-s", &options.dwell_s, "How long it rests before each step", "", "steps-per-turn"},
      {"speeds-dps", &options.speeds_dps,
       "Speeds of a motor that turns one way (deg/s), each for an equal part of the recording", "A,B,...", "",
       false},
      {"speed-ramp", &options.speed_ramp,
       "Turn evenly faster or slower from one of --speeds-dps to the next"},
      {"encoder-step-deg", &options.encoder_step_deg, "The encoder's resolution"},
      {"encoder-hz", &options.encoder_hz, "Motor samples per second"},
      {"encoder-jitter-ms", &typed.encoder_jitter_ms, "Standard deviation of the sampling instants"},
      {"imu", &options.imu, "Also record a gyroscope on the base, as sensor_msgs/Imu on /imu"},
      {"imu-shift-ms", &typed.imu_shift_ms, "t_laser = t_imu + time shift", "", "imu"}};
}

std::vector<SimulationOption> world_options(TypedSimulation& typed) {
  const auto names = [](const char* what, const std::vector<std::string_view>& list) {
    return fmt::format("{}: {} (default SEED: --seed)", what, fmt::join(list, ", "));
  };
  return {
      {"world", &typed.world, names("A place drawn at random instead of SCENE", simulation::world_names()),
       "NAME[:SEED]", "", false},
      {"walk", &typed.walk, names("How the rig is carried through it", simulation::walk_names()),
       "NAME[:SEED]", "world", false}};
}

std::vector<SimulationOption> own_scene_options(TypedSimulation& typed) {
  OwnScene& own = typed.options.own;
  return {
      {"mesh", &own.mesh, "A triangle mesh (PLY or OBJ) instead of SCENE, in metres, z up", "M.ply", "",
       false},
      {"trajectory", &own.trajectory,
       "The rig's motion, smoothed by a spline; without it the rig is stationary at --trajectory-at", "T.tum",
       "mesh", false},
      {"trajectory-at", &typed.at_m, "Move the mean of its positions to this point (default: not moved)",
       "X,Y,Z", "mesh", false},
      {"trajectory-yaw-deg", &own.placement.yaw_deg, "Rotate it about the vertical through that point", "",
       "mesh"},
      {"trajectory-scale", &own.placement.scale, "Scale its positions about their mean", "", "trajectory"},
      {"trajectory-upright", &own.placement.upright,
       "Mount the rig so that it is level on average, whatever frame was recorded", "", "trajectory"},
      {"trajectory-from-s", &own.from_s, "Skip its first seconds", "", "trajectory"},
      {"trajectory-smoothing-ms", &typed.smoothing_ms, "Time between the knots of the spline", "",
       "trajectory"}};
}

std::vector<SimulationOption> message_options(TypedSimulation& typed) {
  SimulationOptions& options = typed.options;
  return {
      {"beam-times", &typed.beam_times,
       "When the beams are fired: spread over the scan, instant (all at the stamp, time_increment 0) or "
       "reversed (the last beam of the array first) (default: as the scanner's driver writes)",
       "", "", false},
      {"stamp-at", &typed.stamp_at, "The beam whose time is the stamp: first_beam or last_beam"},
      {"no-time-increment", &options.no_time_increment, "Write a time_increment of 0"},
      {"scan-time-factor", &options.scan_time_factor, "Write a scan_time that is wrong by this factor"},
      {"parts", &typed.parts, "Write each turn of the mirror as this many messages"},
      {"motor-messages", &typed.motor_messages,
       "What is recorded of the motor: joint-states, index (one message a turn), none; a rig file beside OUT says how it turns"},
      {"motor-repeats", &typed.motor_repeats,
       "Write each motor angle this many times, under new stamps, before the next one"},
      {"motor-in-degrees", &options.motor_in_degrees, "Write the motor's angles in degrees"}};
}

std::vector<SimulationOption> faults(TypedSimulation& typed) {
  SimulationOptions& options = typed.options;
  return {
      {"mixed-pixels", &options.mixed_pixels, "Fraction of beams at an edge that return a range in between"},
      {"grazing-bias-mm", &typed.grazing_bias_mm,
       "Range bias at grazing incidence; none at perpendicular incidence"},
      {"stamp-jitter-ms", &typed.stamp_jitter_ms, "Standard deviation added to every header stamp"},
      {"backlash-deg", &options.backlash_deg, "Play between the encoder and the laser"},
      {"clock-drift-ppm", &options.clock_drift_ppm, "How much faster the motor's clock runs"},
      {"jump-ms", &typed.jump_ms, "By how much the motor's clock jumps forward at --jump-at-s"},
      {"jump-at-s", &options.jump_at_s, "When it jumps, in seconds since the first scan"},
      {"nudge-mm", &typed.nudge_mm, "Push the rig sideways, one second after the start"},
      {"noise-per-m-mm", &typed.noise_per_m_mm, "Added to the noise for every metre of range"},
      {"grazing-dropout", &options.grazing_dropout,
       "Fraction of beams lost at grazing incidence and on dark surfaces"},
      {"mount-error-deg", &typed.mount_error_deg,
       "Rotation error of the laser on the motor: roll, pitch, yaw", "R,P,Y"},
      {"mount-error-mm", &typed.mount_error_mm, "Translation error of the laser on the motor", "X,Y,Z"},
      {"eccentricity-deg", &options.eccentricity_deg,
       "Amplitude A of the encoder's eccentricity: it shows angle + A sin(angle + phase)"},
      {"eccentricity-phase-deg", &options.eccentricity_phase_deg, "Phase of the eccentricity"},
      {"uneven-motor", &options.uneven_motor, "Maximum fraction by which the motor's speed varies"},
      {"people", &options.people, "Number of people who walk through the scene"},
      {"glass", &options.glass, "Fraction of the upright surfaces that are glass"}};
}

tl::unexpected<Error> not_one_of(const char* option, const std::string& text,
                                 const std::vector<std::string_view>& names) {
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{} needs one of {}, not '{}'", option, fmt::join(names, ", "), text));
}

/// The options that are names, and counts.
Result<void> take_names(const TypedSimulation& typed, SimulationOptions& options) {
  const auto scanner = simulation::scanner(typed.scanner);
  if (!scanner) return not_one_of("--scanner", typed.scanner, simulation::scanner_names());
  options.scanner = *scanner;
  const auto axis = simulation::motor_axis(typed.axis);
  if (!axis) return not_one_of("--axis", typed.axis, {"x", "y", "z", "-x", "-y", "-z"});
  options.axis = *axis;
  const auto messages = motor_messages(typed.motor_messages);
  if (!messages)
    return not_one_of("--motor-messages", typed.motor_messages, {"joint-states", "index", "none"});
  options.motor_messages = *messages;
  if (!typed.beam_times.empty()) options.beam_times = simulation::beam_times(typed.beam_times);
  if (!typed.beam_times.empty() && !options.beam_times)
    return not_one_of("--beam-times", typed.beam_times, simulation::beam_times_names());
  if (typed.stamp_at != "first_beam" && typed.stamp_at != "last_beam")
    return not_one_of("--stamp-at", typed.stamp_at, {"first_beam", "last_beam"});
  options.stamp_at = typed.stamp_at == "first_beam" ? StampAt::kFirstBeam : StampAt::kLastBeam;
  options.parts = static_cast<std::uint32_t>(std::max(0, typed.parts));
  options.motor_repeats = static_cast<std::uint32_t>(std::max(0, typed.motor_repeats));
  return {};
}

/// "yard:7" into its name and seed.
Result<void> take_seeded(const char* option, std::string_view text, std::string& name, std::uint64_t& seed) {
  const std::size_t colon = text.find(':');
  name = text.substr(0, colon);
  if (colon == std::string_view::npos) return {};
  const std::string_view digits = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
  if (error == std::errc() && end == digits.data() + digits.size()) return {};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{} needs NAME or NAME:SEED with a whole number, not '{}'", option, text));
}

/// The world and the walk, if one is asked for.
Result<void> take_world(const TypedSimulation& typed, SimulationOptions& options) {
  if (typed.world.empty()) return {};
  if (!typed.scene.empty() || !options.own.mesh.empty())
    return failure(ExitCode::kWrongUsage, "--world takes the place of SCENE and of --mesh: name one of them");
  RandomWorld& random = options.random;
  random.world_seed = random.walk_seed = options.seed;
  return take_seeded("--world", typed.world, random.world, random.world_seed).and_then([&] {
    return typed.walk.empty() ? Result<void>{}
                              : take_seeded("--walk", typed.walk, random.walk, random.walk_seed);
  });
}

}  // namespace

Result<SimulationOptions> simulation_of(const TypedSimulation& typed) {
  SimulationOptions options = typed.options;
  if (typed.scene.empty() && options.own.mesh.empty() && typed.world.empty())
    return failure(ExitCode::kWrongUsage, "name a SCENE, a --world, or a mesh of yours with --mesh");
  if (!typed.scene.empty()) options.scene = typed.scene;
  const auto motor = simulation::motor_kind(typed.motor);
  if (!motor)
    return failure(ExitCode::kWrongUsage,
                   fmt::format("there is no motor '{}'; the motors are {}", typed.motor,
                               fmt::join(simulation::motor_names(), ", ")));
  options.motor = *motor;
  if (auto named = take_names(typed, options); !named) return tl::unexpected(named.error());
  if (auto world = take_world(typed, options); !world) return tl::unexpected(world.error());
  options.offset_s = typed.offset_ms / 1e3;
  if (typed.noise_mm) options.noise_m = *typed.noise_mm / 1e3;
  options.encoder_jitter_s = typed.encoder_jitter_ms / 1e3;
  options.grazing_bias_m = typed.grazing_bias_mm / 1e3;
  options.stamp_jitter_s = typed.stamp_jitter_ms / 1e3;
  options.nudge_m = typed.nudge_mm / 1e3;
  options.jump_s = typed.jump_ms / 1e3;
  options.noise_per_m = typed.noise_per_m_mm / 1e3;
  options.imu_shift_s = typed.imu_shift_ms / 1e3;
  options.own.placement.smoothing_s = typed.smoothing_ms / 1e3;
  const auto error_deg = triple(typed.mount_error_deg), error_mm = triple(typed.mount_error_mm);
  if (!error_deg) return not_a_triple("--mount-error-deg", typed.mount_error_deg);
  if (!error_mm) return not_a_triple("--mount-error-mm", typed.mount_error_mm);
  options.mount_error_deg = *error_deg;
  options.mount_error_m = *error_mm / 1e3;
  if (!typed.at_m.empty()) {
    options.own.placement.at_m = triple(typed.at_m);
    if (!options.own.placement.at_m) return not_a_triple("--trajectory-at", typed.at_m);
  }
  return options;
}

std::vector<SimulationOption> simulation_options(TypedSimulation& typed) {
  std::vector<SimulationOption> all = recording_options(typed);
  const auto add = [&all](std::vector<SimulationOption>&& more, Group group) {
    for (SimulationOption& option : more) {
      option.group = group;
      all.push_back(std::move(option));
    }
  };
  add(world_options(typed), Group::kRandomWorld);
  add(own_scene_options(typed), Group::kOwnScene);
  add(message_options(typed), Group::kMessages);
  add(faults(typed), Group::kFaults);
  return all;
}

}  // namespace sweepscope
