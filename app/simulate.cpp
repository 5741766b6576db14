#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "app/commands.hpp"
#include "app/progress.hpp"
#include "app/recording_options.hpp"
#include "app/say.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/scenes/scene.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/typed_simulation.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope::app {
namespace {

/// The options and the file to write.
struct Typed : TypedSimulation {
  std::filesystem::path output;
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
  if (!o.own.trajectory.empty())
    text += fmt::format("  the smoothed walk is {:.2f} mm and {:.3f} deg from the recorded poses (RMS)\n",
                        simulation.deviation.position_m * 1e3,
                        simulation::degrees(simulation.deviation.rotation_rad));
  text += fmt::format("  the truth is in {} and {}", truth_json_path(output).string(),
                      truth_tum_path(output).filename().string());
  const std::vector<std::filesystem::path> files = files_of_simulation(o, output);
  if (files.back() == rig_path(output))
    text += fmt::format("\n  {} says how it is to be read (--rig)", files.back().filename().string());
  return text;
}

Result<Simulation> simulate_into(const SimulationOptions& options, const std::filesystem::path& output) {
  std::vector<std::string> files;
  for (const auto& file : files_of_simulation(options, output)) files.push_back(file.string());
  const auto checked = check_outputs(files, {options.own.mesh, options.own.trajectory});
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
  const auto options = simulation_of(typed);
  if (!options) return fail(options.error());
  const auto simulation = simulate_into(*options, typed.output);
  if (!simulation) return fail(simulation.error());
  print("{}\n", summary(*simulation, typed.output));
  return ExitCode::kDone;
}

CLI::Option* declare(CLI::App& app, const SimulationOption& option) {
  const std::string name = "--" + option.name;
  return std::visit(
      [&](auto* value) -> CLI::Option* {
        if constexpr (std::is_same_v<decltype(value), bool*>) {
          return app.add_flag(name, *value, option.help);
        } else {
          CLI::Option* declared = app.add_option(name, *value, option.help);
          if constexpr (std::is_same_v<decltype(value), std::vector<double>*>) declared->delimiter(',');
          return option.has_default ? declared->capture_default_str() : declared;
        }
      },
      option.value);
}

void declare_options(CLI::App& app, CLI::Option& scene, Typed& typed) {
  for (const SimulationOption& option : simulation_options(typed)) {
    CLI::Option* declared = declare(app, option);
    if (!option.type.empty()) declared->type_name(option.type);
    if (!option.needs.empty()) declared->needs(app.get_option("--" + option.needs));
    if (option.name == "mesh" || option.name == "world") declared->excludes(&scene);
    if (option.group == SimulationOption::Group::kRandomWorld)
      declared->group("A place and a walk at random");
    if (option.group == SimulationOption::Group::kOwnScene) declared->group("A scene and a walk of your own");
    if (option.group == SimulationOption::Group::kMessages) declared->group("How drivers write messages");
    if (option.group == SimulationOption::Group::kFaults) declared->group("Faults of real rigs");
  }
}

}  // namespace

void add_simulate(CLI::App& app, ExitCode& exit_code) {
  CLI::App* simulate =
      app.add_subcommand("simulate", "Simulate a recording with a known offset, as a ROS 1 bag");
  const auto typed = std::make_shared<Typed>();
  CLI::Option* scene = simulate
                           ->add_option("SCENE", typed->scene,
                                        fmt::format("One of {}", fmt::join(simulation::scene_names(), ", ")))
                           ->type_name("");
  simulate
      ->add_option(
          "-o,--output", typed->output,
          "The bag; beside it OUT.truth.json, OUT.truth.tum and, where reading it needs one, OUT.rig.yaml")
      ->required()
      ->type_name("OUT.bag");
  declare_options(*simulate, *scene, *typed);
  simulate->callback([typed, &exit_code] { exit_code = run(*typed); });
}

}  // namespace sweepscope::app
