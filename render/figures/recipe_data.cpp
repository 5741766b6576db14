#include <algorithm>

#include "core/simulation/scenes/scene.hpp"
#include "render/figures/recipe_parts.hpp"

namespace sweepscope::recipe_parts {
namespace {

using yaml::Members, yaml::read_choice, yaml::read_list, yaml::read_members, yaml::read_text, yaml::refuse;
using YAML::Node;

std::string read_scene(const Node& node, const std::string& name) {
  const std::string scene = read_text(node, name + ": simulate");
  const auto& known = simulation::scene_names();
  if (std::find(known.begin(), known.end(), scene) == known.end()) {
    refuse(node, fmt::format("there is no scene \"{}\"; there are: {}", scene, fmt::join(known, ", ")));
  }
  return scene;
}

/// Members for all options of an estimate; what they set goes to `options`.
Members estimate_members(EstimateOptions& options, const std::string& name) {
  Members members;
  for (const EstimateOption& option : estimate_options()) {
    members[option.name] = [&options, &option, name](const Node& node) {
      const std::vector<Node> values = option.repeats ? read_list(node) : std::vector<Node>{node};
      for (const Node& value : values) {
        const std::string text = read_text(value, name + ": " + option.name);
        if (const auto set = option.set(options, text); !set)
          refuse(value, fmt::format("{}: {} {}, not \"{}\"", name, option.name, set.error().message, text));
      }
    };
  }
  return members;
}

}  // namespace

double read_within(const Node& node, const std::string& name, double min, double max) {
  const double number = yaml::read_number(node, name);
  if (number < min || number > max) {
    refuse(node, fmt::format("{} must be within {:g} to {:g}", name, min, max));
  }
  return number;
}

std::vector<double> read_numbers(const Node& node, const std::string& name, std::size_t count) {
  if (!node.IsSequence() || node.size() != count) {
    refuse(node, fmt::format("{} must be {} numbers", name, count));
  }
  std::vector<double> numbers;
  for (const Node& one : node) numbers.push_back(yaml::read_number(one, name));
  return numbers;
}

RecordingSpec read_recording(const std::string& key, const Node& node, const Recipe& recipe) {
  const std::string name = "recording " + key;
  const std::filesystem::path folder = recipe.path.parent_path();
  RecordingSpec spec;
  RecordedFile file;
  SimulationOptions simulation;
  bool simulated = false, simulation_keys = false, file_keys = false;
  const auto number = [&](double& into, double min, double max, double unit) {
    return [&, min, max, unit](const Node& value) {
      into = unit * read_within(value, name, min, max);
      simulation_keys = true;
    };
  };
  read_members(
      node, name,
      {{"file", [&](const Node& v) { file.path = folder / read_text(v, name + ": file"); }},
       {"rig", [&](const Node& v) { file.rig = folder / read_text(v, name + ": rig"), file_keys = true; }},
       {"stamps",
        [&](const Node& v) {
          file.stamps = read_choice<StampSource>(
              v, name + ": stamps", {{"header", StampSource::kHeader}, {"receive", StampSource::kReceive}});
          file_keys = true;
        }},
       {"window_s",
        [&](const Node& v) {
          const auto window = read_numbers(v, name + ": window_s", 2);
          if (!(window[0] < window[1])) refuse(v, name + ": window_s must ascend");
          spec.window_s = {window[0], window[1]};
        }},
       {"simulate", [&](const Node& v) { simulation.scene = read_scene(v, name), simulated = true; }},
       {"offset_ms", number(simulation.offset_s, -10000, 10000, 1e-3)},
       {"noise_mm", number(simulation.noise_m.emplace(simulation.scanner.noise_m), 0, 1000, 1e-3)},
       {"dropout", number(simulation.dropout, 0, 1, 1)},
       {"sweep_s", number(simulation.sweep_s, 0.05, 60, 1)},
       {"seed",
        [&](const Node& v) {
          simulation.seed = static_cast<std::uint64_t>(read_within(v, name + ": seed", 0, 9e15));
          simulation_keys = true;
        }},
       {"duration_s", [&](const Node& v) {
          simulation.duration_s = read_within(v, name + ": duration_s", 0.1, 1e5);
          simulation_keys = true;
        }}});
  if (simulated == !file.path.empty()) refuse(node, name + " needs either simulate or file");
  if (simulated ? file_keys : simulation_keys) {
    refuse(node, fmt::format("{}: {}", name,
                             simulated ? "rig and stamps belong to a file"
                                       : "offset, noise, seed and the like belong to a simulation"));
  }
  if (simulated) {
    spec.source = simulation;
  } else {
    spec.source = file;
  }
  return spec;
}

EstimateSpec read_estimate(const std::string& key, const Node& node, const Recipe& recipe) {
  const std::string name = "estimate " + key;
  EstimateSpec spec;
  EstimateOptions& options = spec.options;
  const std::map<std::string, RigKind> kinds{{"stationary", RigKind::kStationary},
                                             {"moving", RigKind::kMoving}};
  Members members = estimate_members(options, name);
  members["recording"] = [&](const Node& v) {
    spec.recording = read_reference(v, recipe.recordings, "recording");
  };
  members["file"] = [&](const Node& v) {
    spec.file = recipe.path.parent_path() / read_text(v, name + ": file");
  };
  members["assume"] = [&](const Node& v) {
    options.assume = read_choice<RigKind>(v, name + ": assume", kinds);
  };
  members["ranges_ms"] = [&](const Node& v) {
    for (const Node& one : read_list(v)) {
      const auto range = read_numbers(one, name + ": a range of ranges_ms", 3);
      if (!(range[0] <= range[1]) || !(range[2] > 0)) {
        refuse(one, name + ": a range must be [from, to, step] with from <= to and step > 0");
      }
      options.ranges.push_back({range[0] * 1e-3, range[1] * 1e-3, range[2] * 1e-3});
    }
  };
  read_members(node, name, members);
  if (spec.recording.empty()) refuse(node, name + " needs a recording");
  if (!spec.file.empty() && node.size() > 2)
    refuse(node, name + ": a file is not computed: it has no options");
  return spec;
}

std::vector<std::string> read_estimate_names(const Node& node, const Recipe& recipe) {
  std::vector<std::string> names;
  for (const Node& one : read_list(node)) names.push_back(read_reference(one, recipe.estimates, "estimate"));
  return names;
}

}  // namespace sweepscope::recipe_parts
