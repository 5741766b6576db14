#include "render/points.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sweepscope {
namespace {

constexpr std::uint64_t kCellsPerAxis = 1U << 21;

/// Spreads 21 bits out to every third bit.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  bits = (bits | bits << 2) & 0x1249249249249249;
  return bits;
}

std::uint64_t cell(double along_m, double edge_m) {
  return static_cast<std::uint64_t>(
      std::clamp(along_m / edge_m, 0.0, static_cast<double>(kCellsPerAxis - 1)));
}

std::array<float, 3> least_corner(const ColouredPoints& points) {
  std::array<float, 3> least;
  least.fill(std::numeric_limits<float>::max());
  for (const auto& point : points.xyz_m) {
    for (std::size_t axis = 0; axis < 3; ++axis) least[axis] = std::min(least[axis], point[axis]);
  }
  return least;
}

struct Keyed {
  std::uint64_t morton;
  std::uint32_t index;
  bool operator<(const Keyed& other) const {
    return morton != other.morton ? morton < other.morton : index < other.index;
  }
};

/// The points' cells along a Morton curve, those of one cell in the input's order.
std::vector<Keyed> keys_along_curve(const ColouredPoints& points, double edge_m) {
  const std::array<float, 3> origin = least_corner(points);
  std::vector<Keyed> keyed(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const auto& point = points.xyz_m[i];
      std::uint64_t morton = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        morton |= spread(cell(static_cast<double>(point[axis]) - origin[axis], edge_m)) << axis;
      }
      keyed[i] = {morton, static_cast<std::uint32_t>(i)};
    }
  });
  tbb::parallel_sort(keyed.begin(), keyed.end());
  return keyed;
}

/// The first point of each cell; a cell is what shares a key without its last `bits`.
ColouredPoints first_of_cells(const ColouredPoints& points, const std::vector<Keyed>& keyed, int bits) {
  ColouredPoints out;
  for (std::size_t k = 0; k < keyed.size(); ++k) {
    if (k > 0 && keyed[k].morton >> bits == keyed[k - 1].morton >> bits) continue;
    out.add(points.xyz_m[keyed[k].index], points.values[keyed[k].index]);
  }
  return out;
}

std::size_t count_cells(const std::vector<Keyed>& keyed, int bits) {
  std::size_t count = keyed.empty() ? 0 : 1;
  for (std::size_t k = 1; k < keyed.size(); ++k) {
    count += keyed[k].morton >> bits != keyed[k - 1].morton >> bits ? 1 : 0;
  }
  return count;
}

}  // namespace

ColouredPoints thin(const ColouredPoints& points, double edge_m) {
  return first_of_cells(points, keys_along_curve(points, edge_m), 0);
}

ColouredPoints decimated(const ColouredPoints& points, std::size_t most) {
  constexpr double kFinest_m = 1e-3;
  constexpr int kBitsPerStep = 3, kMostBits = 60;
  const std::vector<Keyed> keyed = keys_along_curve(points, kFinest_m);
  int bits = 0;
  while (bits < kMostBits && count_cells(keyed, bits) > most) bits += kBitsPerStep;
  return first_of_cells(points, keyed, bits);
}

}  // namespace sweepscope
