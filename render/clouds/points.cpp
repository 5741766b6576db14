#include "render/clouds/points.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/geometry/morton.hpp"

namespace sweepscope {
namespace {

std::array<float, 3> min_corner(const ColouredPoints& points) {
  std::array<float, 3> least;
  least.fill(std::numeric_limits<float>::max());
  for (const auto& point : points.xyz_m) {
    for (std::size_t axis = 0; axis < 3; ++axis) least[axis] = std::min(least[axis], point[axis]);
  }
  return least;
}

/// The points' cells along a Morton curve, those of one cell in the input's order.
std::vector<MortonKey> keys_along_curve(const ColouredPoints& points, double edge_m) {
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0);
  return along_morton_curve(points.xyz_m, all, min_corner(points), edge_m);
}

/// The first point of each cell; a cell is what shares a key without its last `bits`.
ColouredPoints first_of_cells(const ColouredPoints& points, const std::vector<MortonKey>& keyed, int bits) {
  ColouredPoints out;
  for (std::size_t k = 0; k < keyed.size(); ++k) {
    if (k > 0 && keyed[k].code >> bits == keyed[k - 1].code >> bits) continue;
    out.add(points.xyz_m[keyed[k].index], points.values[keyed[k].index]);
  }
  return out;
}

std::size_t count_cells(const std::vector<MortonKey>& keyed, int bits) {
  std::size_t count = keyed.empty() ? 0 : 1;
  for (std::size_t k = 1; k < keyed.size(); ++k) {
    count += keyed[k].code >> bits != keyed[k - 1].code >> bits ? 1 : 0;
  }
  return count;
}

}  // namespace

ColouredPoints thin(const ColouredPoints& points, double edge_m) {
  return first_of_cells(points, keys_along_curve(points, edge_m), 0);
}

ColouredPoints decimated(const ColouredPoints& points, std::size_t most) {
  constexpr double kFinest_m = 1e-3;
  constexpr int kBitsPerStep = 3, kMaxBits = 60;
  const std::vector<MortonKey> keyed = keys_along_curve(points, kFinest_m);
  int bits = 0;
  while (bits < kMaxBits && count_cells(keyed, bits) > most) bits += kBitsPerStep;
  return first_of_cells(points, keyed, bits);
}

}  // namespace sweepscope
