#include "render/figures/figure_table.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

TableCell ms(std::optional<double> value_s) {
  // Whole picoseconds: no binary tails such as 9.000000000000002.
  return value_s ? TableCell(std::round(*value_s * 1e12) / 1e9) : TableCell();
}

std::optional<double> optimum(const Estimate& estimate, std::string_view criterion,
                              double CriterionOptimum::*member) {
  for (const CriterionOptimum& one : estimate.criteria) {
    if (one.name == criterion) return one.*member;
  }
  return std::nullopt;
}

TableCell cell_of(TableValue value, const Estimate& estimate, std::optional<double> truth_s) {
  switch (value) {
    case TableValue::kOffset:
      return ms(estimate.offset_s);
    case TableValue::kSigma:
      return ms(estimate.sigma_s);
    case TableValue::kOffsetByD:
      return ms(optimum(estimate, "d", &CriterionOptimum::offset_s));
    case TableValue::kOffsetByN:
      return ms(optimum(estimate, "n", &CriterionOptimum::offset_s));
    case TableValue::kOffsetByE:
      return ms(optimum(estimate, "e", &CriterionOptimum::offset_s));
    case TableValue::kTruth:
      return ms(truth_s);
    case TableValue::kD: {
      const auto d = optimum(estimate, "d", &CriterionOptimum::value);
      return d ? TableCell(*d) : TableCell();
    }
    case TableValue::kDifference:
      if (!estimate.offset_s || !truth_s) return {};
      return ms(*estimate.offset_s - *truth_s);
  }
  return {};
}

Alignment alignment_of(const ColumnSpec& column) {
  const auto* texts = std::get_if<std::vector<std::string>>(&column.values);
  if (texts == nullptr) return Alignment::kRight;
  const bool numbers = std::all_of(texts->begin(), texts->end(), [](const std::string& text) {
    return text.find_first_not_of("+-.0123456789") == std::string::npos;
  });
  return numbers ? Alignment::kRight : Alignment::kLeft;
}

}  // namespace

Result<Table> figure_table(const TableSpec& spec, const Recipe& recipe, FigureData& data) {
  Table table;
  table.title = spec.title;
  for (const ColumnSpec& column : spec.columns) {
    table.columns.push_back({column.title, column.unit, alignment_of(column), column.decimals});
  }
  for (std::size_t row = 0; row < spec.estimates.size(); ++row) {
    const auto estimate = data.estimate(spec.estimates[row]);
    if (!estimate) return tl::unexpected(estimate.error());
    const auto truth_s = data.truth_s(recipe.estimates.at(spec.estimates[row]).recording);
    std::vector<TableCell>& cells = table.rows.emplace_back();
    for (const ColumnSpec& column : spec.columns) {
      if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values)) {
        cells.emplace_back((*texts)[row]);
      } else {
        cells.push_back(cell_of(std::get<TableValue>(column.values), **estimate, truth_s));
      }
    }
  }
  return table;
}

}  // namespace sweepscope
