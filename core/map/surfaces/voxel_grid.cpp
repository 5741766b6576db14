#include "core/map/surfaces/voxel_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/geometry/morton.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::int32_t kHalf = 1 << 20;

std::uint32_t cell_of(float value_m, double inverse_cell, std::int32_t half) {
  const double cell = std::clamp(std::floor(value_m * inverse_cell), -double(half), half - 1.0);
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(cell) + half);
}

std::size_t hash_of(std::uint64_t key) {
  return static_cast<std::size_t>((key ^ key >> 29) * 0x9e3779b97f4a7c15u >> 20);
}

}  // namespace

VoxelLevel::VoxelLevel(const std::vector<std::uint64_t>& keys, int shift, double cell_m)
    : cell_m_(cell_m), inverse_cell_(1 / cell_m), half_(kHalf >> (shift / 3)) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::uint64_t key = keys[i] >> shift;
    if (!keys_.empty() && keys_.back() == key) continue;
    keys_.push_back(key);
    begin_.push_back(static_cast<std::uint32_t>(i));
  }
  begin_.push_back(static_cast<std::uint32_t>(keys.size()));
  slots_.assign(std::bit_ceil(2 * keys_.size() + 2), kNone);
  for (std::uint32_t cell = 0; cell < cells(); ++cell) {
    std::size_t slot = hash_of(keys_[cell]) & (slots_.size() - 1);
    while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = cell;
  }
}

VoxelLevel::Place VoxelLevel::place(std::uint32_t cell) const {
  const std::uint64_t key = keys_[cell];
  return {static_cast<std::int32_t>(morton_gathered(key)) - half_,
          static_cast<std::int32_t>(morton_gathered(key >> 1)) - half_,
          static_cast<std::int32_t>(morton_gathered(key >> 2)) - half_};
}

VoxelLevel::Place VoxelLevel::place_of(float x_m, float y_m, float z_m) const {
  const auto along = [&](float value_m) {
    return static_cast<std::int32_t>(cell_of(value_m, inverse_cell_, half_)) - half_;
  };
  return {along(x_m), along(y_m), along(z_m)};
}

std::uint32_t VoxelLevel::find(const Place& place) const {
  for (const std::int32_t p : place)
    if (p < -half_ || p >= half_) return kNone;
  const std::uint64_t key =
      morton_code(static_cast<std::uint32_t>(place[0] + half_), static_cast<std::uint32_t>(place[1] + half_),
                  static_cast<std::uint32_t>(place[2] + half_));
  std::size_t slot = hash_of(key) & (slots_.size() - 1);
  while (slots_[slot] != kNone && keys_[slots_[slot]] != key) slot = (slot + 1) & (slots_.size() - 1);
  return slots_[slot];
}

VoxelGrid::VoxelGrid(const MapCloud& cloud, double finest_m)
    : x_m(cloud.size()),
      y_m(cloud.size()),
      z_m(cloud.size()),
      index(cloud.size()),
      finest_m_(finest_m),
      keys_(cloud.size()) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(cloud.size());
  const double inverse_cell = 1 / finest_m;
  for_each_block(cloud.size(), 16384, [&](const auto& block) {
    for (std::size_t i = block.begin(); i < block.end(); ++i) {
      const MapPoint& p = cloud.points[i];
      order[i] = {morton_code(cell_of(p.x, inverse_cell, kHalf), cell_of(p.y, inverse_cell, kHalf),
                              cell_of(p.z, inverse_cell, kHalf)),
                  static_cast<std::uint32_t>(i)};
    }
  });
  sort_in_parallel(order);
  for_each_block(cloud.size(), 16384, [&](const auto& block) {
    for (std::size_t i = block.begin(); i < block.end(); ++i) {
      const MapPoint& p = cloud.points[order[i].second];
      keys_[i] = order[i].first;
      index[i] = order[i].second;
      x_m[i] = p.x;
      y_m[i] = p.y;
      z_m[i] = p.z;
    }
  });
}

VoxelLevel VoxelGrid::level(int doublings) const {
  return VoxelLevel(keys_, 3 * doublings, finest_m_ * (1 << doublings));
}

}  // namespace sweepscope
