#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "core/io/yaml_members.hpp"
#include "render/figures/recipe.hpp"

// The parts of a recipe, each read from its own node; recipe.cpp puts them together. What is invalid throws
// yaml::Refusal.
namespace sweepscope::recipe_parts {

double read_within(const YAML::Node& node, const std::string& name, double min, double max);
std::vector<double> read_numbers(const YAML::Node& node, const std::string& name, std::size_t count);

template <typename T>
std::string read_reference(const YAML::Node& node, const std::map<std::string, T>& all,
                           const std::string& what) {
  const std::string name = yaml::read_text(node, what);
  if (all.count(name) > 0) return name;
  std::string known;
  for (const auto& [key, value] : all) known += (known.empty() ? "" : ", ") + key;
  yaml::refuse(node, fmt::format("there is no {} \"{}\"; there are: {}", what, name, known));
}

/// One name of an estimate, or a list of them.
std::vector<std::string> read_estimate_names(const YAML::Node& node, const Recipe& recipe);

/// Members for all look options; what they set goes to `look`.
yaml::Members look_members(ComparisonOptions& look);

/// The following find the recipe's recordings and estimates in `recipe`, as far as it is read. `name` is that
/// of the entry: "walk".
RecordingSpec read_recording(const std::string& name, const YAML::Node& node, const Recipe& recipe);
EstimateSpec read_estimate(const std::string& name, const YAML::Node& node, const Recipe& recipe);
/// `look` is what the recipe says of all figures.
FigureSpec read_figure(const std::string& name, const YAML::Node& node, const Recipe& recipe,
                       const ComparisonOptions& look);
TableSpec read_table(const std::string& name, const YAML::Node& node, const Recipe& recipe);

}  // namespace sweepscope::recipe_parts
