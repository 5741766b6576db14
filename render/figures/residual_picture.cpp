#include "render/figures/residual_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "render/charts/heat_map.hpp"
#include "render/figures/figure_pictures.hpp"

namespace sweepscope {
namespace {

HeatMap heat_map(const ResidualGrid& grid, const char* when, const ColourScale& colours) {
  HeatMap map;
  map.title = fmt::format("{}: {:.2f} mm rms", when, grid.rms_m() * 1e3);
  map.x_title = "motor angle [°]";
  map.y_title = "beam [°]";
  map.x = {grid.motor.from_rad * kDegPerRad, grid.motor.to_rad * kDegPerRad};
  map.y = {grid.beam.from_rad * kDegPerRad, grid.beam.to_rad * kDegPerRad};
  map.columns = grid.columns;
  map.rows = grid.rows;
  for (const double residual_m : grid.residual_m) map.values.push_back(residual_m * 1e3);
  map.colours = colours;
  return map;
}

}  // namespace

double residual_range_mm(const RigResiduals& residuals) {
  constexpr double kMin_mm = 1;  // below the noise of any scanner's mean
  std::vector<double> sizes_mm;
  for (const ResidualGrid* grid : {&residuals.before, &residuals.after})
    for (const double residual_m : grid->residual_m)
      if (!std::isnan(residual_m)) sizes_mm.push_back(std::abs(residual_m) * 1e3);
  if (sizes_mm.empty()) return kMin_mm;
  const double range_mm = quantile(sizes_mm, 0.98);
  const double digit = std::pow(10.0, std::floor(std::log10(std::max(range_mm, kMin_mm))) - 1);
  return std::max(kMin_mm, std::ceil(range_mm / digit) * digit);  // two digits
}

Picture residual_picture(const RigResiduals& residuals, const ComparisonOptions& look) {
  const bool beside = look.width_px > look.height_px;
  Page page = make_page(look, beside ? 1.6 : 1);
  const double range_mm = residual_range_mm(residuals);
  const ColourScale colours{diverging_table(), -range_mm, range_mm};
  const double bar_room = std::round(70 * page.scale), gap = std::round(18 * page.scale);
  const PixelRect room{page.room.left, page.room.top, page.room.width - bar_room, page.room.height};
  const double width = beside ? std::floor((room.width - gap) / 2) : room.width;
  const double height = beside ? room.height : std::floor((room.height - gap) / 2);
  Drawing& marks = page.picture.marks;
  add_heat_map(marks, {room.left, room.top, width, height},
               heat_map(residuals.before, "With the rig file", colours), page.style, page.scale);
  add_heat_map(marks,
               {beside ? room.left + width + gap : room.left, beside ? room.top : room.top + height + gap,
                width, height},
               heat_map(residuals.after, "With the rig found", colours), page.style, page.scale);
  const double bar_height = std::round(height - 86 * page.scale);
  add_colour_bar(marks,
                 {room.right() + std::round(18 * page.scale), room.top + std::round(44 * page.scale),
                  std::round(14 * page.scale), bar_height},
                 colours, "[mm]", page.style, page.scale);
  return std::move(page.picture);
}

}  // namespace sweepscope
