#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "app/python/handles.hpp"
#include "core/io/output_check.hpp"
#include "core/simulation/scenes/scene.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/typed_simulation.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope::python {
namespace {

void set(const SimulationOption& option, const py::handle& value) {
  std::visit(
      [&](auto* member) {
        try {
          *member = value.cast<std::remove_pointer_t<decltype(member)>>();
        } catch (const py::cast_error&) {
          throw Failed(Error{ExitCode::kWrongUsage,
                             "--" + option.name + " does not take " + py::repr(value).cast<std::string>()});
        }
      },
      option.value);
}

SimulationOptions options_of(const std::optional<std::string>& scene, const py::dict& given) {
  TypedSimulation typed;
  typed.scene = scene.value_or("");
  const std::vector<SimulationOption> declared = simulation_options(typed);
  for (const auto& [key, value] : given) {
    const auto option = std::ranges::find(declared, key.cast<std::string>(), &SimulationOption::name);
    if (option == declared.end()) throw py::type_error("there is no option " + key.cast<std::string>());
    if (!option->needs.empty() && !given.contains(option->needs))
      throw Failed(Error{ExitCode::kWrongUsage, "--" + option->name + " needs --" + option->needs});
    set(*option, value);
  }
  if (!typed.scene.empty() && given.contains("mesh"))
    throw py::value_error("mesh excludes a scene: give None for it");
  return value_of(simulation_of(typed));
}

std::string simulate_into(const std::optional<std::string>& scene, const Path& output, const py::dict& given,
                          const Call& call) {
  const SimulationOptions options = options_of(scene, given);
  value_of(check_run_files(
      {{options.own.mesh, options.own.trajectory}, files_of_simulation(options, output), {}}));
  return result_of(call, [&](const Job& job) {
    return simulate(options, job).and_then([&](const Simulation& simulation) {
      return write_bag(simulation, output, job)
          .and_then([&] { return write_truth(simulation, output); })
          .map([&] { return truth_json(simulation); });
    });
  });
}

}  // namespace

void add_simulation(py::module_& module) {
  module.def("simulate", &simulate_into);
  module.def("scenes", &simulation::scene_names);
  module.def("simulation_options", [] {
    py::list options;
    TypedSimulation typed;
    for (const SimulationOption& option : simulation_options(typed)) {
      py::dict one;
      one["name"] = option.name;
      one["type"] = option.type;
      one["help"] = option.help;
      std::visit([&](const auto* value) { one["default"] = py::cast(*value); }, option.value);
      options.append(one);
    }
    return options;
  });
}

}  // namespace sweepscope::python
