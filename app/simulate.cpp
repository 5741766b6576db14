#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/io/text_cursor.hpp"
#include "core/simulation/portable_math.hpp"
#include "core/simulation/scene.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope::app {
namespace {

/// The options as they are typed, in the command line's units.
struct Typed {
  std::string scene, motor{simulation::name_of(SimulationOptions{}.motor)};
  std::filesystem::path output;
  SimulationOptions options;
  double offset_ms = 24, noise_mm = 10, encoder_jitter_ms = 0.5;
  double grazing_bias_mm = 0, stamp_jitter_ms = 0, nudge_mm = 0, jump_ms = 0;
  double noise_per_m_mm = 0, smoothing_ms = 50, imu_shift_ms = 0;
  std::string mount_error_deg{"0,0,0"}, mount_error_mm{"0,0,0"}, at_m;
};

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

std::string summary(const Simulation& simulation, const std::filesystem::path& output) {
  const SimulationOptions& o = simulation.options;
  std::string text = fmt::format("{}: {} for {:g} s, {} scans, {} motor samples, seed {}\n", output.string(),
                                 o.scene, *o.duration_s, simulation.recording.scans.size(),
                                 simulation.recording.motor.time_s.size(), o.seed);
  text +=
      fmt::format("  t_motor = t_laser {} {:g} ms\n", o.offset_s < 0 ? '-' : '+', std::abs(o.offset_s) * 1e3);
  if (simulation.moving)
    text += fmt::format("  walked {:.1f} m, at most {:.2f} m/s and {:.2f} rad/s\n", simulation.length_m,
                        simulation.top_speed_mps, simulation.top_angular_rate_radps);
  if (!o.own.trajectory.empty())
    text += fmt::format("  the smoothed walk is {:.2f} mm and {:.3f} deg from the recorded poses (RMS)\n",
                        simulation.deviation.position_m * 1e3,
                        simulation::degrees(simulation.deviation.rotation_rad));
  return text + fmt::format("  the truth is in {} and {}", truth_json_path(output).string(),
                            truth_tum_path(output).filename().string());
}

Result<Simulation> simulate_into(const SimulationOptions& options, const std::filesystem::path& output) {
  const auto checked =
      check_outputs({output.string(), truth_json_path(output).string(), truth_tum_path(output).string()},
                    {options.own.mesh, options.own.trajectory});
  if (!checked) return tl::unexpected(checked.error());
  const Progress progress;
  auto simulation = simulate(options, progress.job());
  if (!simulation) return simulation;
  const auto written = write_bag(*simulation, output, progress.job()).and_then([&] {
    return write_truth(*simulation, output);
  });
  if (!written) return tl::unexpected(written.error());
  return simulation;
}

/// What was typed, in the units of the simulation.
Result<SimulationOptions> options_of(const Typed& typed) {
  SimulationOptions options = typed.options;
  if (typed.scene.empty() && options.own.mesh.empty())
    return failure(ExitCode::kWrongUsage, "name a SCENE, or give one of your own with --mesh");
  if (!typed.scene.empty()) options.scene = typed.scene;
  const auto motor = simulation::motor_kind(typed.motor);
  if (!motor)
    return failure(ExitCode::kWrongUsage,
                   fmt::format("there is no motor '{}'; the motors are {}", typed.motor,
                               fmt::join(simulation::motor_names(), ", ")));
  options.motor = *motor;
  options.offset_s = typed.offset_ms / 1e3;
  options.noise_m = typed.noise_mm / 1e3;
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

ExitCode run(const Typed& typed) {
  const auto options = options_of(typed);
  if (!options) return fail(options.error());
  const auto simulation = simulate_into(*options, typed.output);
  if (!simulation) return fail(simulation.error());
  print("{}\n", summary(*simulation, typed.output));
  return ExitCode::kDone;
}

void declare_own_scene(CLI::App& app, CLI::Option* scene, Typed& typed) {
  OwnScene& own = typed.options.own;
  const char* group = "A scene and a walk of your own";
  CLI::Option* mesh =
      app.add_option("--mesh", own.mesh, "A triangle mesh (PLY or OBJ) instead of SCENE, in metres, z up")
          ->type_name("M.ply")
          ->group(group)
          ->excludes(scene);
  CLI::Option* trajectory =
      app.add_option("--trajectory", own.trajectory,
                     "The rig's motion, smoothed by a spline; without it the rig is stationary at "
                     "--trajectory-at")
          ->type_name("T.tum")
          ->group(group)
          ->needs(mesh);
  app.add_option("--trajectory-at", typed.at_m,
                 "Move the mean of its positions to this point (default: not moved)")
      ->type_name("X,Y,Z")
      ->group(group)
      ->needs(mesh);
  app.add_option("--trajectory-yaw-deg", own.placement.yaw_deg,
                 "Rotate it about the vertical through that point")
      ->capture_default_str()
      ->group(group)
      ->needs(mesh);
  app.add_option("--trajectory-scale", own.placement.scale, "Scale its positions about their mean")
      ->capture_default_str()
      ->group(group)
      ->needs(trajectory);
  app.add_flag("--trajectory-upright", own.placement.upright,
               "Mount the rig so that it is level on average, whatever frame was recorded")
      ->group(group)
      ->needs(trajectory);
  app.add_option("--trajectory-from-s", own.from_s, "Skip its first seconds")
      ->capture_default_str()
      ->group(group)
      ->needs(trajectory);
  app.add_option("--trajectory-smoothing-ms", typed.smoothing_ms, "Time between the knots of the spline")
      ->capture_default_str()
      ->group(group)
      ->needs(trajectory);
}

void declare_faults(CLI::App& app, Typed& typed) {
  const auto fault = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help)->capture_default_str()->group("Faults of real rigs");
  };
  fault("--mixed-pixels", typed.options.mixed_pixels,
        "Fraction of beams at an edge that return a range in between");
  fault("--grazing-bias-mm", typed.grazing_bias_mm,
        "Range bias at grazing incidence; none at perpendicular incidence");
  fault("--stamp-jitter-ms", typed.stamp_jitter_ms, "Standard deviation added to every header stamp");
  fault("--backlash-deg", typed.options.backlash_deg, "Play between the encoder and the laser");
  fault("--clock-drift-ppm", typed.options.clock_drift_ppm, "How much faster the motor's clock runs");
  fault("--jump-ms", typed.jump_ms, "By how much the motor's clock jumps forward at --jump-at-s");
  fault("--jump-at-s", typed.options.jump_at_s, "When it does, in seconds since the first scan");
  fault("--nudge-mm", typed.nudge_mm, "Push the rig sideways, one second after the start");
  fault("--noise-per-m-mm", typed.noise_per_m_mm, "Added to the noise for every metre of range");
  fault("--grazing-dropout", typed.options.grazing_dropout,
        "Fraction of beams lost at grazing incidence and on dark surfaces");
  fault("--mount-error-deg", typed.mount_error_deg,
        "Rotation error of the laser on the motor: roll, pitch, yaw")
      ->type_name("R,P,Y");
  fault("--mount-error-mm", typed.mount_error_mm, "Translation error of the laser on the motor")
      ->type_name("X,Y,Z");
  fault("--eccentricity-deg", typed.options.eccentricity_deg,
        "Amplitude A of the encoder's eccentricity: it shows angle + A sin(angle + phase)");
  fault("--eccentricity-phase-deg", typed.options.eccentricity_phase_deg, "Phase of the eccentricity");
  fault("--uneven-motor", typed.options.uneven_motor, "Maximum fraction by which the motor's speed varies");
  fault("--people", typed.options.people, "Number of people who walk through the scene");
  fault("--glass", typed.options.glass, "Fraction of the upright surfaces that are glass");
}

}  // namespace

void add_simulate(CLI::App& app, ExitCode& exit_code) {
  CLI::App* simulate =
      app.add_subcommand("simulate", "Simulate a recording with a known offset, as a ROS 1 bag");
  const auto typed = std::make_shared<Typed>();
  SimulationOptions& options = typed->options;
  CLI::Option* scene = simulate
                           ->add_option("SCENE", typed->scene,
                                        fmt::format("One of {}", fmt::join(simulation::scene_names(), ", ")))
                           ->type_name("");
  simulate->add_option("-o,--output", typed->output, "The bag; beside it OUT.truth.json and OUT.truth.tum")
      ->required()
      ->type_name("OUT.bag");
  const auto option = [&](const char* name, auto& value, const char* help) {
    return simulate->add_option(name, value, help)->capture_default_str();
  };
  option("--offset-ms", typed->offset_ms, "t_motor = t_laser + offset");
  option("--seed", options.seed, "Random seed; the same seed gives the same file");
  simulate->add_option("--duration-s", options.duration_s,
                       "Length of the recording (default: the whole walk, 4.5 s in a room)");
  option("--noise-mm", typed->noise_mm, "Standard deviation of the range noise");
  option("--dropout", options.dropout, "Fraction of beams without a return");
  option("--sweep-s", options.sweep_s, "Duration of one half turn of the motor");
  option("--motor", typed->motor, "triangle, trapezoid, sine, one-way or stuck");
  simulate
      ->add_option("--speeds-dps", options.speeds_dps,
                   "Speeds of a motor that turns one way (deg/s), each for an equal part of the recording")
      ->delimiter(',')
      ->type_name("A,B,...");
  simulate->add_flag("--speed-ramp", options.speed_ramp,
                     "Turn evenly faster or slower from one of --speeds-dps to the next");
  option("--encoder-step-deg", options.encoder_step_deg, "The encoder's resolution");
  option("--encoder-hz", options.encoder_hz, "Motor samples per second");
  option("--encoder-jitter-ms", typed->encoder_jitter_ms, "Standard deviation of the sampling instants");
  CLI::Option* imu = simulate->add_flag("--imu", options.imu,
                                        "Also record a gyroscope on the base, as sensor_msgs/Imu on /imu");
  option("--imu-shift-ms", typed->imu_shift_ms, "t_laser = t_imu + time shift")->needs(imu);
  declare_own_scene(*simulate, scene, *typed);
  declare_faults(*simulate, *typed);
  simulate->callback([typed, &exit_code] { exit_code = run(*typed); });
}

}  // namespace sweepscope::app
