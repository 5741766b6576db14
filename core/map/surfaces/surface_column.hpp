#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "core/map/surfaces/voxel_grid.hpp"

namespace sweepscope {

/// What the measures of all patches of a map have in common.
struct ColumnOptions {
  double reach_m = 0.4;         // of a column to either side of its middle
  double range_noise_m = 0;     // standard deviation of a single sweep's points from a flat surface
  bool both_directions = true;  // nothing is measured where sweeps of one direction alone saw the surface
  bool sweeps_known = true;     // false: the points do not say which sweep they are of
};

/// A flat piece of a map: a disc, and how far the layers reach from it along its normal.
struct SurfacePatch {
  Eigen::Vector3f middle_m = Eigen::Vector3f::Zero();  // a point of the map
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    // of unit length
  float radius_m = 0;
  float from_m = 0, to_m = 0;  // of the layers, along the normal from the middle
  float thickness_m = 0;
  SurfaceKind kind = SurfaceKind::kUnknown;
};

/// The layers of a column, by their heights, and which of them belong to one surface.
class ColumnLayers {
 public:
  static constexpr int kMax = 16;
  /// Layers are parted by gaps of more than `gap_m` without a point.
  ColumnLayers(const std::vector<float>& heights_m, double gap_m);

  int count() const { return count_; }
  int at(float height_m) const;
  /// Joins layers by the sweeps that put points on them; `group` is each point's index into `sweeps`.
  void join(const std::vector<float>& heights_m, const std::vector<std::uint8_t>& group,
            const std::vector<std::uint32_t>& sweeps);
  /// The lowest and the highest layer of the surface that holds height 0, or of one that encloses it.
  std::array<int, 2> middle() const;

 private:
  using Shares = std::array<float, kMax>;
  static int bin_of(float height_m);
  void join(const std::array<Shares, kMax>& across, const Shares& same);

  int count_ = 0;
  std::array<int, kMax> first_bin_{}, last_bin_{}, surface_{};
};

/// Measures the surface through one point of a map after the other, from the points in a column across it.
/// Its radius is the edge of the level's cubes. Holds working memory; make one for each thread.
class SurfaceColumn {
 public:
  SurfaceColumn(const VoxelGrid& grid, const VoxelLevel& level, const ColumnOptions& options);

  /// `seed` is a point in the grid's order.
  SurfacePatch patch_at(std::uint32_t seed);
  /// Standard deviation (m) of the points within single sweeps across the surface through the seed; NaN if
  /// there are too few.
  double range_noise_at_m(std::uint32_t seed);

 private:
  bool gather(std::uint32_t seed);  // the points of the surface through the seed; false: too few
  bool gather_ball();               // false: too few points
  void gather_column();
  template <typename Keep>
  void take(std::uint64_t key, std::uint32_t max_points, const Keep& keep);
  void forget_points();
  void keep_point(const Eigen::Vector3f& p_m, std::uint32_t i);
  void keep_heights(const ColumnLayers& layers);
  std::uint8_t group_of(std::uint32_t sweep);
  bool find_normal();
  double deviation_within_sweeps_m() const;
  bool seen_both_ways() const;
  bool is_filled() const;
  bool has_straight_lines() const;
  bool is_flat(double within_m) const;
  double thickness_m(double within_m);
  double width_m();

  const VoxelGrid& grid_;
  const VoxelLevel& level_;
  const ColumnOptions options_;
  const float radius_m_;
  Eigen::Vector3f middle_m_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal_ = Eigen::Vector3f::Zero(), along_ = Eigen::Vector3f::Zero();
  // Of the points at hand: the position from the middle, in the map's axes in a ball, along and across (z)
  // the surface in a column; and which of the sweeps at hand it is of.
  std::vector<float> x_m_, y_m_, z_m_;
  std::vector<double> time_s_;
  std::vector<std::uint8_t> group_;
  std::vector<std::uint32_t> sweeps_;
  bool sampled_ = false;                   // cubes hold more points than were looked at
  std::array<std::uint8_t, 256> slots_{};  // a hash table from sweeps to indices into sweeps_
};

}  // namespace sweepscope
