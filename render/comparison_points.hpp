#pragma once

#include <span>
#include <vector>

#include "render/comparison.hpp"
#include "render/points.hpp"

namespace sweepscope {

/// A map's points that a view from above shows, coloured by elevation, and the heights above the path.
struct SlabPoints {
  ColouredPoints points;            // value: z in the map frame
  std::vector<float> above_path_m;  // of each point
};

/// The slabs that the options name, or the default ones for these maps.
std::vector<HeightRange> choose_slabs(std::span<const ComparedMap> maps, const ComparisonOptions& options);

SlabPoints points_in_slabs(const ComparedMap& map, std::span<const HeightRange> slabs);

struct Bounds {
  double from = 0, to = 0;
  double length() const { return to - from; }
  double middle() const { return (from + to) / 2; }
};

/// The range of one coordinate (0 to 2) over all maps, without the outermost fraction of the points at each
/// end. Without any point: 0 to 1.
Bounds bounds_of(std::span<const SlabPoints> maps, std::size_t axis, double outermost_fraction);

/// The place where the maps differ most in how many small cells their points fill: a blurred surface fills
/// more. Compact things (a pillar) are preferred over long walls, which look alike along their length.
Region find_close_up(std::span<const SlabPoints> maps, double height_m, double width_m);

}  // namespace sweepscope
