#include "core/map/surfaces/voxel_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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
  std::size_t bricks = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const std::uint64_t key = keys[i] >> shift;
    if (!keys_.empty() && keys_.back() == key) continue;
    if (keys_.empty() || keys_.back() >> kBrickBits != key >> kBrickBits) ++bricks;
    keys_.push_back(key);
    begin_.push_back(static_cast<std::uint32_t>(i));
  }
  begin_.push_back(static_cast<std::uint32_t>(keys.size()));
  bricks_.assign(std::bit_ceil(2 * bricks + 2), Brick());
  for (std::uint32_t cell = 0; cell < cells(); ++cell) {
    const std::uint64_t key = keys_[cell] >> kBrickBits;
    Brick& brick = bricks_[slot_of(key)];
    if (brick.first == kNone) brick = {key, 0, cell};
    brick.cells |= std::uint64_t{1} << (keys_[cell] & ((1U << kBrickBits) - 1));
  }
}

std::size_t VoxelLevel::slot_of(std::uint64_t brick_key) const {
  std::size_t slot = hash_of(brick_key) & (bricks_.size() - 1);
  while (bricks_[slot].first != kNone && bricks_[slot].key != brick_key)
    slot = (slot + 1) & (bricks_.size() - 1);
  return slot;
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

std::uint32_t VoxelLevel::find(std::uint64_t key) const {
  const Brick& brick = bricks_[slot_of(key >> kBrickBits)];
  const std::uint64_t bit = std::uint64_t{1} << (key & ((1U << kBrickBits) - 1));
  if ((brick.cells & bit) == 0) return kNone;
  return brick.first + static_cast<std::uint32_t>(std::popcount(brick.cells & (bit - 1)));
}

VoxelGrid::VoxelGrid(const MapCloud& cloud, double finest_m)
    : x_m(cloud.size()),
      y_m(cloud.size()),
      z_m(cloud.size()),
      sweep(cloud.size()),
      time_s(cloud.size()),
      index(cloud.size()),
      finest_m_(finest_m),
      keys_(cloud.size()) {
  std::vector<MortonKey> order(cloud.size());
  const double inverse_cell = 1 / finest_m;
  for_each_block(cloud.size(), 16384, [&](const auto& block) {
    for (std::size_t i = block.begin(); i < block.end(); ++i) {
      const MapPoint& p = cloud.points[i];
      order[i] = {morton_code(cell_of(p.x, inverse_cell, kHalf), cell_of(p.y, inverse_cell, kHalf),
                              cell_of(p.z, inverse_cell, kHalf)),
                  static_cast<std::uint32_t>(i)};
    }
  });
  sort_along_curve(order);
  for_each_block(cloud.size(), 16384, [&](const auto& block) {
    for (std::size_t i = block.begin(); i < block.end(); ++i) {
      const MapPoint& p = cloud.points[order[i].index];
      keys_[i] = order[i].code;
      index[i] = order[i].index;
      sweep[i] = p.sweep;
      time_s[i] = p.time_s;
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
