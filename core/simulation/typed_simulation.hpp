#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope {

/// The options of a simulation as a person gives them, in the units of their names. The members that
/// `options` has as well take the place of those.
struct TypedSimulation {
  std::string scene;        // empty: a scene of one's own, or a world
  std::string world, walk;  // "yard" or "yard:7"; without a seed that of `options`
  std::string motor{simulation::name_of(SimulationOptions{}.motor)}, axis{"x"},
      motor_messages{"joint-states"};
  std::string scanner{SimulationOptions{}.scanner.name}, beam_times,
      stamp_at{"first_beam"};  // empty: the scanner's
  SimulationOptions options;
  double offset_ms = 24, encoder_jitter_ms = 0.5;
  std::optional<double> noise_mm;
  int parts = 1, motor_repeats = 1;
  double grazing_bias_mm = 0, stamp_jitter_ms = 0, nudge_mm = 0, jump_ms = 0;
  double noise_per_m_mm = 0, smoothing_ms = 50, imu_shift_ms = 0;
  std::string mount_error_deg{"0,0,0"}, mount_error_mm{"0,0,0"}, at_m;
};

/// What was typed, in the units of the simulation. A scene or a motor that does not exist, and a text that is
/// not three numbers, are ExitCode::kWrongUsage.
Result<SimulationOptions> simulation_of(const TypedSimulation& typed);

/// One option of a simulation, declared once: the command line's `--name VALUE` and Python's keyword come
/// from it.
struct SimulationOption {
  enum class Group { kRecording, kRandomWorld, kOwnScene, kMessages, kFaults };
  using Value = std::variant<bool*, int*, std::uint64_t*, double*, std::optional<double>*,
                             std::vector<double>*, std::string*, std::filesystem::path*>;

  std::string name;         // "offset-ms"
  Value value;              // a member of a TypedSimulation
  std::string help;         // a sentence or less
  std::string type = {};    // what a text looks like: "X,Y,Z"; empty: of the kind of `value`
  std::string needs = {};   // the option without which it has no meaning; empty: none
  bool has_default = true;  // that a help text can show
  Group group = Group::kRecording;
};

/// All of them but the scene, in the order of the help text. They write to `typed`, which must outlive them.
std::vector<SimulationOption> simulation_options(TypedSimulation& typed);

}  // namespace sweepscope
