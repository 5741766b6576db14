#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sweepscope::ui {

/// The order in which points are drawn, and the selection that is drawn while something moves.
struct DrawOrder {
  std::vector<std::uint32_t> all;     // along a Morton curve, several times faster to draw than at random
  std::vector<std::uint32_t> chosen;  // one point for each of the cubes that fill the map, ascending
  std::vector<std::uint32_t> chosen_order;  // indices into `chosen`, along the curve
  // How far apart points are around each of all, and around each of `chosen` among these (spacing_of); 0 for
  // those that are alone or left out.
  std::vector<float> spacing_m, chosen_spacing_m;
};

/// Points that are not finite are left out. At most `max_chosen` are chosen, and not many fewer: the edge of
/// the cubes is found for that. The same for any number of threads.
DrawOrder order_for_drawing(std::span<const std::array<float, 3>> xyz_m, std::size_t max_chosen);

}  // namespace sweepscope::ui
