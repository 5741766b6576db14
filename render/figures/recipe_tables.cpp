#include "render/figures/recipe_parts.hpp"

namespace sweepscope::recipe_parts {
namespace {

using YAML::Node;
using yaml::read_choice, yaml::read_list, yaml::read_members, yaml::read_text, yaml::refuse;

ColumnSpec read_column(const Node& node, const std::string& name, std::size_t rows) {
  ColumnSpec column;
  bool has_values = false;
  read_members(node, name + ": a column",
               {{"title", [&](const Node& v) { column.title = read_text(v, name + ": title"); }},
                {"unit", [&](const Node& v) { column.unit = read_text(v, name + ": unit"); }},
                {"decimals",
                 [&](const Node& v) {
                   column.decimals = static_cast<int>(read_within(v, name + ": decimals", 0, 9));
                 }},
                {"value",
                 [&](const Node& v) {
                   column.values = read_choice<TableValue>(v, name + ": value",
                                                           {{"offset", TableValue::kOffset},
                                                            {"sigma", TableValue::kSigma},
                                                            {"offset-by-d", TableValue::kOffsetByD},
                                                            {"d", TableValue::kD},
                                                            {"offset-by-n", TableValue::kOffsetByN},
                                                            {"offset-by-e", TableValue::kOffsetByE},
                                                            {"truth", TableValue::kTruth},
                                                            {"difference", TableValue::kDifference}});
                   has_values = true;
                 }},
                {"values", [&](const Node& v) {
                   std::vector<std::string> texts;
                   for (const Node& one : read_list(v)) texts.push_back(read_text(one, name + ": values"));
                   if (texts.size() != rows) {
                     refuse(v, fmt::format("{}: {} values for {} estimates", name, texts.size(), rows));
                   }
                   column.values = std::move(texts);
                   has_values = true;
                 }}});
  if (!has_values) refuse(node, name + ": a column needs value or values");
  return column;
}

}  // namespace

TableSpec read_table(const std::string& key, const Node& node, const Recipe& recipe) {
  const std::string name = "table " + key;
  TableSpec spec;
  spec.name = key;
  Node columns;
  read_members(node, name,
               {{"title", [&](const Node& v) { spec.title = read_text(v, name + ": title"); }},
                {"estimates", [&](const Node& v) { spec.estimates = read_estimate_names(v, recipe); }},
                {"columns", [&](const Node& v) { columns.reset(v); }}});
  if (spec.estimates.empty()) refuse(node, name + " needs estimates");
  if (!columns.IsDefined() || !columns.IsSequence()) refuse(node, name + " needs a list of columns");
  for (const Node& column : columns) {
    spec.columns.push_back(read_column(column, name, spec.estimates.size()));
  }
  return spec;
}

}  // namespace sweepscope::recipe_parts
