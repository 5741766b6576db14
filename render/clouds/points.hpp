#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/morton.hpp"

namespace sweepscope {

/// Points for pictures: positions in metres, and the value that colours each.
struct ColouredPoints {
  std::vector<std::array<float, 3>> xyz_m;
  std::vector<float> values;

  std::size_t size() const { return xyz_m.size(); }
  void add(const std::array<float, 3>& point, float value) {
    xyz_m.push_back(point);
    values.push_back(value);
  }
};

/// One point for each non-empty cube of the given edge, the first in the input's order, with the cubes along
/// a Morton curve: points close in space are close in memory, which draws several times faster than a random
/// order. The same input gives the same output for any number of threads.
ColouredPoints thin(const ColouredPoints& points, double edge_m);

/// How far apart points are on the surface around each, in metres: by their number in the smallest cube (from
/// 2 cm to 1.3 m) that holds enough of them. 0 for points that are alone. The same for any number of threads.
std::vector<float> spacing_of(std::span<const std::array<float, 3>> xyz_m);
/// The same for points along a Morton curve through cubes of `edge_m`, by their indices among `count` points.
std::vector<float> spacing_along(std::span<const MortonKey> keyed, double edge_m, std::size_t count);

/// At most this many points, for moving pictures: one for each cube of the smallest edge (in steps of 2) that
/// is large enough. Evenly distributed in space rather than at random, so that the look is kept; in the same
/// order as thin.
ColouredPoints decimated(const ColouredPoints& points, std::size_t max_points);

}  // namespace sweepscope
