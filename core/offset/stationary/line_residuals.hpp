#pragma once

// A stationary rig's scan lines against each other at one offset. The mathematics: docs/algorithms.md,
// section 8.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/offset/stationary/stationary_points.hpp"

namespace sweepscope {

/// A point against a patch of the other direction, at one offset.
struct PatchDistance {
  double jacobian_m_s = 0, distance_m = 0;  // dr / d offset and r
  float lever_m = 0, reach_m = 0;           // n . (a x p) and |a x p|
};
PatchDistance distance_to_patch(const StationaryPatch& patch, const Eigen::Vector3d& p_m, double speed_rad_s,
                                const Eigen::Vector3d& motor_axis);

/// One line's points against the other direction's patches.
struct LineResiduals {
  std::vector<PatchDistance> residuals;
  std::vector<std::size_t> cells;  // of the residuals, ascending
  std::size_t features = 0;

  void add(std::size_t cell, const PatchDistance& residual) {
    residuals.push_back(residual);
    cells.push_back(cell);
  }
};

/// Gauss-Newton's equation of the offset: jj step = -jr, with Cauchy weights.
struct OffsetEquation {
  double jj = 0, jr = 0;
  std::size_t features = 0, matches = 0;

  /// Adds a line at the offset of its residuals plus `ahead_s`.
  void add(const LineResiduals& line, double loss_width_m, double ahead_s = 0);
  double step_s() const { return -jr / jj; }
};
OffsetEquation offset_equation(const std::vector<LineResiduals>& lines, double loss_width_m);

/// Which part each cell belongs to, kNoSweep where to none.
struct CellParts {
  static constexpr std::size_t kMost = 32;  // bits of PartsOfPatches
  std::vector<std::size_t> of_cell;
  std::size_t count = 0;
};

/// The parts that each cell's patch takes points from, a bit for each.
using PartsOfPatches = std::vector<std::uint32_t>;

/// The grid's points at one offset, and their distances to the patches of the other direction.
class StationaryLinearisation {
 public:
  StationaryLinearisation(const StationaryGrid& grid, const StationaryPatchOptions& patches, double offset_s);

  const StationaryPoints& points() const { return points_; }

  /// All lines against the other direction's.
  std::vector<LineResiduals> residuals() const;

  /// Each line against the other direction's lines of its own block: what the blocks say independently of
  /// each other.
  std::vector<LineResiduals> residuals_within(const std::vector<std::size_t>& block_of_line,
                                              std::size_t blocks) const;

  PartsOfPatches parts_of_patches(const CellParts& parts) const;

  /// Has all points of `whole` but those of a part.
  void leave_out(const CellParts& parts, std::size_t part, const StationaryLinearisation& whole);

  /// All lines after leave_out. A patch without points of the part is as it was: its residual is that of
  /// `lines`, which had all points.
  std::vector<LineResiduals> residuals_without(std::size_t part, const PartsOfPatches& of_patches,
                                               const std::vector<LineResiduals>& lines) const;

 private:
  LineResiduals of_line(std::size_t line, const LinePool& pool) const;
  LineResiduals of_line_without(std::size_t part, const PartsOfPatches& of_patches, std::size_t line,
                                const LineResiduals& whole) const;
  std::optional<PatchDistance> of_cell(std::size_t cell, StationaryNeighbours& neighbours) const;

  const StationaryGrid& grid_;
  const StationaryPatchOptions& patches_;
  Eigen::Vector3d axis_;
  StationaryPoints points_;
};

}  // namespace sweepscope
