#pragma once

// The mathematics: docs/rig.md.

#include <cstddef>
#include <vector>

#include "core/loam/sweep_features.hpp"
#include "core/rig_solve/rig_unknowns.hpp"

namespace sweepscope {

/// Angles of a grid.
struct AngleRange {
  double from_rad = 0, to_rad = 0;  // from its first edge to its last
};

/// How far points lie from the flat surfaces that they belong to, over the motor's angle and the direction of
/// the beam in the laser's frame. A wrong mount shows as a pattern, range noise as a grey field.
struct ResidualGrid {
  AngleRange motor, beam;   // the edges of the grid
  std::size_t columns = 0;  // along the motor's angle; 0: nothing could be compared
  std::size_t rows = 0;     // along the beam's direction, the least first
  /// The median of each bin, row by row; positive beyond the surface as the laser sees it. NaN in a bin with
  /// too few points.
  std::vector<double> residual_m;

  /// Whether nothing was computed.
  bool empty() const { return residual_m.empty(); }
  /// The residual of a bin.
  double at(std::size_t column, std::size_t row) const { return residual_m[row * columns + column]; }
  /// Root mean square over the bins that have points: the pattern without the noise of single points.
  double rms_m() const;
};

/// The same points and surfaces with two rigs.
struct RigResiduals {
  ResidualGrid before, after;        // with the rig as it was given, and as it was found
  double before_m = 0, after_m = 0;  // robust deviation of all points from their surfaces
};

/// The size of the grids.
struct ResidualGridOptions {
  std::size_t columns = 30, rows = 30;  // at most: a column is at least as wide as the motor turns in a scan
  std::size_t min_points = 4;           // in a bin
  double loss_width_m = 0.03;           // of the fit that found `after`
};

/// The residuals of a stationary rig with `before` and with `after`, which deviate from the rig file as in
/// RigUnknowns. The surfaces are those found with `after`; each one's plane is fitted to the same points with
/// either rig. Empty grids if no surface is found with `after`.
RigResiduals rig_residuals(const OffsetProblem& problem, const RigUnknowns& before, const RigUnknowns& after,
                           const ResidualGridOptions& options);

}  // namespace sweepscope
