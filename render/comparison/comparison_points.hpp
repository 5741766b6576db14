#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/clouds/points.hpp"
#include "render/comparison/comparison.hpp"

namespace sweepscope {

/// The points of a map at the heights shown, with the values that colour them, and their heights above the
/// path.
struct SlabPoints {
  ColouredPoints points;
  std::vector<float> above_path_m;
};

/// The slabs of the options, or the default ones for these maps.
std::vector<HeightRange> choose_slabs(std::span<const ComparedMap> maps, const ComparisonOptions& options);

/// The points of a map at these heights, as ascending indices.
std::vector<std::uint32_t> indices_in_slabs(const ComparedMap& map, std::span<const HeightRange> slabs);

/// `values`: one for each point of the map. Without a box all positions are inside.
SlabPoints points_in_slabs(const ComparedMap& map, std::span<const float> values,
                           std::span<const HeightRange> slabs, const std::optional<Box>& box = {});

/// The points that a view shows, of those higher above the path than `min_height_m`; at most as many as its
/// pixels can show.
std::shared_ptr<const ColouredPoints> points_seen(const SlabPoints& map, const Projection& projection,
                                                  float min_height_m);

struct Bounds {
  double from = 0, to = 0;
  double length() const { return to - from; }
  double middle() const { return (from + to) / 2; }
};

/// The range of one coordinate (0 to 2) over all maps, without a fraction of the points at each end. Without
/// points: 0 to 1.
Bounds bounds_of(std::span<const SlabPoints> maps, std::size_t axis, double outermost_fraction);

/// The places where the maps differ most in the number of small cells that their points fill, best first: a
/// blurred surface fills more. Compact objects (a pillar) are preferred over long walls, which look the same
/// along their length. Close-ups of that size show each place once. Maps that are equal differ nowhere.
std::vector<DifferingPlace> differing_places(std::span<const SlabPoints> maps, double height_m,
                                             double width_m, std::size_t max_count);

/// The height of a close-up that suits maps of that extent.
double close_up_height_m(double extent_m);

/// The first of them, or the middle of the maps.
Region find_close_up(std::span<const SlabPoints> maps, double height_m, double width_m);

}  // namespace sweepscope
