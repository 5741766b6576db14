#pragma once

#include "core/error.hpp"
#include "core/io/table.hpp"
#include "render/figures/figure_data.hpp"

namespace sweepscope {

/// A row for each of the table's estimates.
Result<Table> figure_table(const TableSpec& spec, const Recipe& recipe, FigureData& data);

}  // namespace sweepscope
