#include "render/figures/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/io/yaml_members.hpp"
#include "render/figures/recipe_parts.hpp"

namespace sweepscope {
namespace {

using YAML::Node;
using yaml::read_members, yaml::refuse;

constexpr std::uint64_t kMaxRecipe_bytes = std::uint64_t{1} << 20;

/// Names of files: nothing that would leave the folder.
void check_file_name(const std::string& name, const Node& node) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
  if (!plain || name.front() == '.') {
    refuse(node, fmt::format("\"{}\" is not a name of letters, digits, dots, dashes and underscores", name));
  }
}

/// Calls `read` for each entry of a part of the recipe, if it has that part.
void for_each_entry(const Node& node, const std::string& part,
                    const std::function<void(const std::string&, const Node&)>& read) {
  if (!node.IsDefined() || node.IsNull()) return;
  yaml::for_each_entry(node, part, [&](const std::string& key, const Node& key_node, const Node& value) {
    check_file_name(key, key_node);
    read(key, value);
  });
}

Recipe read_document(const Node& document, const std::filesystem::path& path) {
  Node recordings, estimates, figures, tables, look;
  const auto keep = [](Node& into) { return [&into](const Node& node) { into.reset(node); }; };
  read_members(document, "the recipe",
               {{"recordings", keep(recordings)},
                {"estimates", keep(estimates)},
                {"figures", keep(figures)},
                {"tables", keep(tables)},
                {"look", keep(look)}});
  Recipe recipe;
  recipe.path = path;
  ComparisonOptions common_look;
  if (look.IsDefined() && !look.IsNull()) read_members(look, "look", recipe_parts::look_members(common_look));
  // Figures name estimates, and these name recordings: so in this order, whatever the file's.
  for_each_entry(recordings, "recordings", [&](const std::string& name, const Node& node) {
    recipe.recordings[name] = recipe_parts::read_recording(name, node, recipe);
  });
  for_each_entry(estimates, "estimates", [&](const std::string& name, const Node& node) {
    recipe.estimates[name] = recipe_parts::read_estimate(name, node, recipe);
  });
  for_each_entry(figures, "figures", [&](const std::string& name, const Node& node) {
    recipe.figures.push_back(recipe_parts::read_figure(name, node, recipe, common_look));
  });
  for_each_entry(tables, "tables", [&](const std::string& name, const Node& node) {
    recipe.tables.push_back(recipe_parts::read_table(name, node, recipe));
  });
  if (recipe.figures.empty() && recipe.tables.empty()) {
    refuse(document, "the recipe has neither figures nor tables");
  }
  return recipe;
}

}  // namespace

Result<Recipe> read_recipe(const std::filesystem::path& path) {
  Recipe recipe;
  return yaml::read_file(path, "a recipe", kMaxRecipe_bytes,
                         [&](const Node& document) { recipe = read_document(document, path); })
      .map([&] { return std::move(recipe); });
}

Result<Recipe> parse_recipe(const std::string& text, const std::string& name) {
  Recipe recipe;
  return yaml::read_document(text, name,
                             [&](const Node& document) { recipe = read_document(document, name); })
      .map([&] { return std::move(recipe); });
}

}  // namespace sweepscope
