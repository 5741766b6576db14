#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/map_cloud.hpp"

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
  std::uint32_t find(const Place& place) const;

 private:
  double cell_m_;
  double inverse_cell_;
  std::int32_t half_ = 0;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> begin_, slots_;
};

/// A cloud's points along a Morton curve, so that cubes of any doubling of the finest edge are runs of
/// neighbours. Coordinates within 2^20 finest cubes of the origin; beyond, points share the outermost cubes.
class VoxelGrid {
 public:
  VoxelGrid(const MapCloud& cloud, double finest_m);

  std::size_t size() const { return index.size(); }
  /// Cubes of finest_m * 2^doublings.
  VoxelLevel level(int doublings) const;

  std::vector<float> x_m, y_m, z_m;  // of every point, in the order of the curve
  std::vector<std::uint32_t> index;  // of every point, into the cloud

 private:
  double finest_m_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace sweepscope
