#include "ui/model/spatial_order.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sweepscope::ui {
namespace {

constexpr int kBits = 21;  // of a cube's number along each axis

struct Keyed {
  std::uint64_t morton;
  std::uint32_t index;
  bool operator<(const Keyed& other) const {
    return morton != other.morton ? morton < other.morton : index < other.index;
  }
};

/// Spreads 21 bits out to every third bit.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x001f00000000ffff;
  bits = (bits | bits << 16) & 0x001f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  bits = (bits | bits << 2) & 0x1249249249249249;
  return bits;
}

struct Box {
  std::array<float, 3> least{}, greatest{};
  double longest() const {
    double edge = 1e-3;
    for (std::size_t axis = 0; axis < 3; ++axis)
      edge = std::max(edge, static_cast<double>(greatest[axis]) - static_cast<double>(least[axis]));
    return edge;
  }
};

Box box_of(std::span<const std::array<float, 3>> points, std::span<const std::uint32_t> indices) {
  Box box;
  box.least.fill(std::numeric_limits<float>::max());
  box.greatest.fill(std::numeric_limits<float>::lowest());
  for (const std::uint32_t i : indices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.least[axis] = std::min(box.least[axis], points[i][axis]);
      box.greatest[axis] = std::max(box.greatest[axis], points[i][axis]);
    }
  }
  return box;
}

std::vector<Keyed> sorted_by_cube(std::span<const std::array<float, 3>> points,
                                  std::span<const std::uint32_t> indices, const Box& box, double edge_m) {
  std::vector<Keyed> keyed(indices.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, indices.size(), 4096), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      std::uint64_t morton = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double along =
            static_cast<double>(points[indices[k]][axis]) - static_cast<double>(box.least[axis]);
        const auto cell = static_cast<std::uint64_t>(std::clamp(along / edge_m, 0.0, std::exp2(kBits) - 1));
        morton |= spread(cell) << axis;
      }
      keyed[k] = {morton, indices[k]};
    }
  });
  tbb::parallel_sort(keyed.begin(), keyed.end());
  return keyed;
}

/// How many cubes hold a point when they are 2^level times as large as those of the keys.
std::size_t cubes_at(const std::vector<Keyed>& keyed, int level) {
  std::size_t count = keyed.empty() ? 0 : 1;
  for (std::size_t k = 1; k < keyed.size(); ++k)
    count += (keyed[k].morton >> (3 * level)) != (keyed[k - 1].morton >> (3 * level)) ? 1 : 0;
  return count;
}

/// The cubes' edge for about `wanted` of them, between the two doublings that enclose it.
double edge_for(const std::vector<Keyed>& keyed, double finest_m, std::size_t wanted) {
  int level = 1;
  std::size_t finer = keyed.size(), coarser = cubes_at(keyed, level);
  while (level < kBits && coarser > wanted) {
    finer = coarser;
    coarser = cubes_at(keyed, ++level);
  }
  const double ratio = static_cast<double>(finer) / static_cast<double>(std::max<std::size_t>(coarser, 1));
  const double excess = static_cast<double>(finer) / static_cast<double>(wanted);
  const double part = ratio > 1 ? std::clamp(std::log(excess) / std::log(ratio), 0.0, 1.0) : 1.0;
  return finest_m * std::exp2(level - 1 + part) * 1.05;
}

void choose(DrawOrder& order, const std::vector<Keyed>& cubes) {
  std::vector<std::uint32_t> along_curve;
  for (std::size_t k = 0; k < cubes.size(); ++k) {
    if (k == 0 || cubes[k].morton != cubes[k - 1].morton) along_curve.push_back(cubes[k].index);
  }
  order.chosen = along_curve;
  std::sort(order.chosen.begin(), order.chosen.end());
  for (const std::uint32_t index : along_curve) {
    const auto at = std::lower_bound(order.chosen.begin(), order.chosen.end(), index);
    order.chosen_order.push_back(static_cast<std::uint32_t>(at - order.chosen.begin()));
  }
}

}  // namespace

DrawOrder order_for_drawing(std::span<const std::array<float, 3>> xyz_m, std::size_t most_chosen) {
  std::vector<std::uint32_t> finite;
  finite.reserve(xyz_m.size());
  for (std::uint32_t i = 0; i < xyz_m.size(); ++i) {
    if (std::isfinite(xyz_m[i][0])) finite.push_back(i);
  }
  DrawOrder order;
  if (finite.empty()) return order;
  const Box box = box_of(xyz_m, finite);
  const double finest_m = box.longest() * std::exp2(-kBits);
  const std::vector<Keyed> along_curve = sorted_by_cube(xyz_m, finite, box, finest_m);
  for (const Keyed& keyed : along_curve) order.all.push_back(keyed.index);
  if (finite.size() <= most_chosen) {
    choose(order, along_curve);
    return order;
  }
  double edge_m = edge_for(along_curve, finest_m, most_chosen);
  do {
    order.chosen.clear();
    order.chosen_order.clear();
    choose(order, sorted_by_cube(xyz_m, finite, box, edge_m));
    edge_m *= 1.1;
  } while (order.chosen.size() > most_chosen);
  return order;
}

}  // namespace sweepscope::ui
