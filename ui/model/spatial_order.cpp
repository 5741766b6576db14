#include "ui/model/spatial_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/morton.hpp"
#include "render/clouds/points.hpp"

namespace sweepscope::ui {
namespace {

struct PointBox {
  std::array<float, 3> least{}, greatest{};
  double longest() const {
    double edge = 1e-3;
    for (std::size_t axis = 0; axis < 3; ++axis)
      edge = std::max(edge, static_cast<double>(greatest[axis]) - static_cast<double>(least[axis]));
    return edge;
  }
};

PointBox box_of(std::span<const std::array<float, 3>> points, std::span<const std::uint32_t> indices) {
  PointBox box;
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

/// How many cubes hold a point when they are 2^level times as large as those of the keys.
std::size_t cubes_at(const std::vector<MortonKey>& keyed, int level) {
  std::size_t count = keyed.empty() ? 0 : 1;
  for (std::size_t k = 1; k < keyed.size(); ++k)
    count += (keyed[k].code >> (3 * level)) != (keyed[k - 1].code >> (3 * level)) ? 1 : 0;
  return count;
}

/// The cubes' edge for about `wanted` of them, between the two doublings that enclose it.
double edge_for(const std::vector<MortonKey>& keyed, double finest_m, std::size_t wanted) {
  int level = 1;
  std::size_t finer = keyed.size(), coarser = cubes_at(keyed, level);
  while (level < kMortonBits && coarser > wanted) {
    finer = coarser;
    coarser = cubes_at(keyed, ++level);
  }
  const double ratio = static_cast<double>(finer) / static_cast<double>(std::max<std::size_t>(coarser, 1));
  const double excess = static_cast<double>(finer) / static_cast<double>(wanted);
  const double part = ratio > 1 ? std::clamp(std::log(excess) / std::log(ratio), 0.0, 1.0) : 1.0;
  return finest_m * std::exp2(level - 1 + part) * 1.05;
}

void choose(DrawOrder& order, const std::vector<MortonKey>& cubes) {
  std::vector<std::uint32_t> along_curve;
  for (std::size_t k = 0; k < cubes.size(); ++k) {
    if (k == 0 || cubes[k].code != cubes[k - 1].code) along_curve.push_back(cubes[k].index);
  }
  order.chosen = along_curve;
  std::sort(order.chosen.begin(), order.chosen.end());
  for (const std::uint32_t index : along_curve) {
    const auto at = std::lower_bound(order.chosen.begin(), order.chosen.end(), index);
    order.chosen_order.push_back(static_cast<std::uint32_t>(at - order.chosen.begin()));
  }
}

std::vector<float> spacing_among_chosen(const DrawOrder& order, std::span<const std::array<float, 3>> xyz_m) {
  std::vector<std::array<float, 3>> places;
  for (const std::uint32_t i : order.chosen) places.push_back(xyz_m[i]);
  return spacing_of(places);
}

}  // namespace

DrawOrder order_for_drawing(std::span<const std::array<float, 3>> xyz_m, std::size_t max_chosen) {
  std::vector<std::uint32_t> finite;
  finite.reserve(xyz_m.size());
  for (std::uint32_t i = 0; i < xyz_m.size(); ++i) {
    if (std::isfinite(xyz_m[i][0])) finite.push_back(i);
  }
  DrawOrder order;
  if (finite.empty()) return order;
  const PointBox box = box_of(xyz_m, finite);
  const double finest_m = box.longest() * std::exp2(-kMortonBits);
  const std::vector<MortonKey> along_curve = along_morton_curve(xyz_m, finite, box.least, finest_m);
  for (const MortonKey& key : along_curve) order.all.push_back(key.index);
  order.spacing_m = spacing_along(along_curve, finest_m, xyz_m.size());
  if (finite.size() <= max_chosen) {
    choose(order, along_curve);
    order.chosen_spacing_m = spacing_among_chosen(order, xyz_m);
    return order;
  }
  double edge_m = edge_for(along_curve, finest_m, max_chosen);
  do {
    order.chosen.clear();
    order.chosen_order.clear();
    choose(order, along_morton_curve(xyz_m, finite, box.least, edge_m));
    edge_m *= 1.1;
  } while (order.chosen.size() > max_chosen);
  order.chosen_spacing_m = spacing_among_chosen(order, xyz_m);
  return order;
}

}  // namespace sweepscope::ui
