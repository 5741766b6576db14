#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/simulation/scene.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_bag.hpp"
#include "core/simulation/write_truth.hpp"

namespace sweepscope::app {
namespace {

/// The options as they are typed, in the command line's units.
struct Typed {
  std::string scene, motor{simulation::name_of(SimulationOptions{}.motor)};
  std::filesystem::path output;
  SimulationOptions options;
  double offset_ms = 24, noise_mm = 10, encoder_jitter_ms = 0.5;
  double grazing_bias_mm = 0, stamp_jitter_ms = 0, nudge_mm = 0;
};

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
  return text + fmt::format("  the truth is in {} and {}", truth_json_path(output).string(),
                            truth_tum_path(output).filename().string());
}

Result<Simulation> simulate_into(const SimulationOptions& options, const std::filesystem::path& output) {
  const auto checked =
      check_outputs({output.string(), truth_json_path(output).string(), truth_tum_path(output).string()}, {});
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

ExitCode run(const Typed& typed) {
  SimulationOptions options = typed.options;
  options.scene = typed.scene;
  const auto motor = simulation::motor_kind(typed.motor);
  if (!motor)
    return fail({ExitCode::kWrongUsage, fmt::format("there is no motor '{}'; the motors are {}", typed.motor,
                                                    fmt::join(simulation::motor_names(), ", "))});
  options.motor = *motor;
  options.offset_s = typed.offset_ms / 1e3;
  options.noise_m = typed.noise_mm / 1e3;
  options.encoder_jitter_s = typed.encoder_jitter_ms / 1e3;
  options.grazing_bias_m = typed.grazing_bias_mm / 1e3;
  options.stamp_jitter_s = typed.stamp_jitter_ms / 1e3;
  options.nudge_m = typed.nudge_mm / 1e3;
  const auto simulation = simulate_into(options, typed.output);
  if (!simulation) return fail(simulation.error());
  print("{}\n", summary(*simulation, typed.output));
  return ExitCode::kDone;
}

void declare_faults(CLI::App& app, Typed& typed) {
  const auto fault = [&](const char* name, double& value, const char* help) {
    app.add_option(name, value, help)->capture_default_str()->group("Faults of real rigs");
  };
  fault("--mixed-pixels", typed.options.mixed_pixels,
        "Part of the beams at an edge that return a range in between");
  fault("--grazing-bias-mm", typed.grazing_bias_mm,
        "Added to a range, the more the more the beam grazes the surface");
  fault("--stamp-jitter-ms", typed.stamp_jitter_ms, "Standard deviation added to every header stamp");
  fault("--backlash-deg", typed.options.backlash_deg, "Play between the encoder and the laser");
  fault("--clock-drift-ppm", typed.options.clock_drift_ppm, "How much faster the motor's clock runs");
  fault("--nudge-mm", typed.nudge_mm, "Push the rig aside by this, one second after the start");
}

}  // namespace

void add_simulate(CLI::App& app, ExitCode& exit_code) {
  CLI::App* simulate =
      app.add_subcommand("simulate", "Make a recording whose offset is known, as a ROS 1 bag");
  const auto typed = std::make_shared<Typed>();
  SimulationOptions& options = typed->options;
  simulate
      ->add_option("SCENE", typed->scene,
                   fmt::format("One of {}", fmt::join(simulation::scene_names(), ", ")))
      ->required()
      ->type_name("");
  simulate->add_option("-o,--output", typed->output, "The bag; beside it OUT.truth.json and OUT.truth.tum")
      ->required()
      ->type_name("OUT.bag");
  const auto option = [&](const char* name, auto& value, const char* help) {
    return simulate->add_option(name, value, help)->capture_default_str();
  };
  option("--offset-ms", typed->offset_ms, "t_motor = t_laser + offset");
  option("--seed", options.seed, "Of all that is random; equal seeds give equal bytes");
  simulate->add_option("--duration-s", options.duration_s,
                       "The first seconds only (default: the whole walk, 4.5 in a room)");
  option("--noise-mm", typed->noise_mm, "Standard deviation of a range");
  option("--dropout", options.dropout, "Part of the beams that return nothing");
  option("--sweep-s", options.sweep_s, "One half turn of the motor");
  option("--motor", typed->motor, "triangle, trapezoid, sine, one-way or stuck");
  option("--encoder-step-deg", options.encoder_step_deg, "The encoder's resolution");
  option("--encoder-hz", options.encoder_hz, "Motor samples per second");
  option("--encoder-jitter-ms", typed->encoder_jitter_ms, "Standard deviation of the sampling instants");
  declare_faults(*simulate, *typed);
  simulate->callback([typed, &exit_code] { exit_code = run(*typed); });
}

}  // namespace sweepscope::app
