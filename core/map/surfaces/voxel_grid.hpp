#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/geometry/morton.hpp"

namespace sweepscope {

/// Runs of a VoxelGrid's points that lie in one cube, found by the cube's position.
class VoxelLevel {
 public:
  /// Cubes of edge `cell_m` are runs of equal `keys[i] >> shift`; keys ascend.
  VoxelLevel(const std::vector<std::uint64_t>& keys, int shift, double cell_m);

  static constexpr std::uint32_t kNone = 0xffffffffu;
  using Place = std::array<std::int32_t, 3>;  // floor(coordinate / cell_m)

  double cell_m() const { return cell_m_; }
  std::uint32_t cells() const { return static_cast<std::uint32_t>(keys_.size()); }
  /// The points of a cell are [begin(cell), begin(cell + 1)).
  std::uint32_t begin(std::uint32_t cell) const { return begin_[cell]; }
  Place place(std::uint32_t cell) const;
  Place place_of(float x_m, float y_m, float z_m) const;
  /// The cell at a position; kNone if it holds no point.
  std::uint32_t find(const Place& place) const {
    return find(along(0, place[0]) | along(1, place[1]) | along(2, place[2]));
  }
  /// The same in two steps, for many cells of the same rows: what a position along one axis adds to a key,
  /// and the cell of a key.
  std::uint64_t along(int axis, std::int32_t position) const {
    if (position < -half_ || position >= half_) return kOutside;
    return morton_spread(static_cast<std::uint64_t>(position + half_)) << axis;
  }
  /// Of a position and its two neighbours, ascending.
  std::array<std::uint64_t, 3> beside(int axis, const Place& place) const {
    return {along(axis, place[axis] - 1), along(axis, place[axis]), along(axis, place[axis] + 1)};
  }
  std::uint32_t find(std::uint64_t key) const;

 private:
  static constexpr std::uint64_t kOutside = ~std::uint64_t{0};
  static constexpr int kBrickBits = 6;
  // Cubes of 4 x 4 x 4 cells are runs of the curve as well: which of the cells there are, and the first of
  // them.
  struct Brick {
    std::uint64_t key = kOutside, cells = 0;
    std::uint32_t first = kNone;
  };
  std::size_t slot_of(std::uint64_t brick_key) const;

  double cell_m_;
  double inverse_cell_;
  std::int32_t half_ = 0;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> begin_;
  std::vector<Brick> bricks_;  // hashed by their keys
};

/// A cloud's points along a Morton curve, so that cubes of any doubling of the finest edge are runs of
/// neighbours. Coordinates within 2^20 finest cubes of the origin; beyond, points share the outermost cubes.
class VoxelGrid {
 public:
  VoxelGrid(const MapCloud& cloud, double finest_m);

  std::size_t size() const { return index.size(); }
  /// Cubes of finest_m * 2^doublings.
  VoxelLevel level(int doublings) const;

  // Of every point, in the order of the curve.
  std::vector<float> x_m, y_m, z_m;
  std::vector<std::uint32_t> sweep;
  std::vector<double> time_s;
  std::vector<std::uint32_t> index;  // into the cloud

 private:
  double finest_m_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace sweepscope
