#include "render/clouds/points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/geometry/morton.hpp"

namespace sweepscope {
namespace {

std::array<float, 3> min_corner(std::span<const std::array<float, 3>> xyz_m) {
  std::array<float, 3> corner;
  corner.fill(std::numeric_limits<float>::max());
  for (const auto& point : xyz_m) {
    for (std::size_t axis = 0; axis < 3; ++axis) corner[axis] = std::min(corner[axis], point[axis]);
  }
  return corner;
}

/// The points' cells along a Morton curve, those of one cell in the input's order.
std::vector<MortonKey> keys_along_curve(std::span<const std::array<float, 3>> xyz_m, double edge_m) {
  std::vector<std::uint32_t> all(xyz_m.size());
  std::iota(all.begin(), all.end(), 0);
  return along_morton_curve(xyz_m, all, min_corner(xyz_m), edge_m);
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
  return first_of_cells(points, keys_along_curve(points.xyz_m, edge_m), 0);
}

std::vector<float> spacing_along(std::span<const MortonKey> keyed, double edge_m, std::size_t count) {
  constexpr double kSmallest_m = 0.02, kLargest_m = 1.3;
  constexpr std::size_t kEnough = 6;
  std::vector<float> spacing_m(count, 0);
  for (int level = 0; std::ldexp(edge_m, level) < kLargest_m && level < kMortonBits; ++level) {
    const double cube_m = std::ldexp(edge_m, level);
    if (cube_m < kSmallest_m) continue;
    for (std::size_t from = 0, to = 0; from < keyed.size(); from = to) {
      const std::uint64_t cube = keyed[from].code >> 3 * level;
      while (to < keyed.size() && keyed[to].code >> 3 * level == cube) ++to;
      if (to - from < kEnough) continue;
      const auto here_m = static_cast<float>(cube_m / std::sqrt(static_cast<double>(to - from)));
      for (std::size_t k = from; k < to; ++k) {
        float& spacing = spacing_m[keyed[k].index];
        if (spacing == 0) spacing = here_m;
      }
    }
  }
  return spacing_m;
}

std::vector<float> spacing_of(std::span<const std::array<float, 3>> xyz_m) {
  constexpr double kEdge_m = 0.02;
  return spacing_along(keys_along_curve(xyz_m, kEdge_m), kEdge_m, xyz_m.size());
}

ColouredPoints decimated(const ColouredPoints& points, std::size_t max_points) {
  constexpr double kFinest_m = 1e-3;
  constexpr int kBitsPerStep = 3, kMaxBits = 60;
  const std::vector<MortonKey> keyed = keys_along_curve(points.xyz_m, kFinest_m);
  int bits = 0;
  while (bits < kMaxBits && count_cells(keyed, bits) > max_points) bits += kBitsPerStep;
  return first_of_cells(points, keyed, bits);
}

}  // namespace sweepscope
