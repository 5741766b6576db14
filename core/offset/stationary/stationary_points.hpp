#pragma once

// The mathematics: docs/algorithms.md, section 8.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/kinematics.hpp"
#include "core/loam/sweep_features.hpp"

namespace sweepscope {

/// A stationary rig measures one range per motor angle and beam, in either direction of turning.
/// Its plane points therefore lie in a grid of scan lines (rows) and bins of beams (columns), and a point's
/// neighbours are the same bins of the lines next to it in motor angle: found by counting, without a tree.
struct StationaryGrid {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  const OffsetProblem* problem = nullptr;
  std::size_t bins = 0;
  std::vector<std::uint32_t> scan;     // per line, index into Recording::scans
  std::vector<std::uint32_t> feature;  // per cell, index into the plane features; kNone where there is none
  std::vector<double> time_s;          // per cell, laser clock
  std::vector<float> range_m;          // per cell
  std::size_t lines() const { return scan.size(); }
};

/// The grid of the scans that are used. The problem must outlive it.
StationaryGrid stationary_grid(const OffsetProblem& problem);

/// The scan lines of some sweeps of one side (see Sweep), ring by ring, in the order of their motor angle.
using LinePool = std::vector<std::uint32_t>;

/// The grid's points at one offset. Cells within a reversal's unsteady part are not `placed`.
struct StationaryPoints {
  std::size_t bins = 0;
  double offset_s = 0;
  std::vector<std::size_t> sweep;  // per line; kNoSweep where the line belongs to none
  std::vector<int> direction;      // per line; of a motor that turns one way Sweep::side
  std::vector<double> angle_rad;   // per cell, the motor's; of a motor that turns one way without whole turns
  std::vector<float> speed_rad_s;  // per cell, the motor's, signed
  std::vector<Eigen::Vector3d> p_m;  // per cell, base frame
  std::vector<char> placed;          // per cell
  std::vector<std::uint16_t> ring;   // per line; empty where there is one ring only
  std::array<LinePool, 2> pool;      // all lines turning down, up; or slower, faster

  std::size_t lines() const { return sweep.size(); }
  std::uint16_t ring_of(std::uint32_t line) const { return ring.empty() ? std::uint16_t{0} : ring[line]; }
  const LinePool& against(int turning) const { return pool[turning > 0 ? 0 : 1]; }
};

/// Which values of the points are computed: the coarse search needs no coordinates.
enum class StationaryDetail { kAngles, kPoints };
StationaryPoints place_stationary(const StationaryGrid& grid, double offset_s, StationaryDetail detail);

/// The lines of each sweep by its index.
std::vector<LinePool> pools_by_sweep(const StationaryPoints& points);

/// How a point's neighbours are chosen. Lines as close as encoder steps do not determine a surface's slope,
/// so a minimum distance is required.
struct StationaryPatchOptions {
  double min_gap_rad = 0;          // between neighbouring lines of a patch
  double reach_rad = 0;            // of lines to either side of the point
  int lines_per_side = 3;          // at most StationaryNeighbours::kMaxLinesPerSide
  double thickness_m = 0.006;      // a patch's points lie this near to its plane (rms) ...
  double thickness_slope = 0.003;  // ... or this much of the range
};
StationaryPatchOptions stationary_patch_options(const OffsetProblem& problem);

/// A plane through the points round one cell, on at least three scan lines and on both sides of it.
struct StationaryPatch {
  bool found = false;
  Eigen::Vector3d centre_m, normal;
  double speed_rad_s = 0;  // the motor's mean speed while its points were measured
};

/// Goes through a line's cells in order and finds each one's neighbours among the lines of a pool.
class StationaryNeighbours {
 public:
  static constexpr int kMaxLinesPerSide = 4;  // options for more get these

  /// Of a scanner with rings only the lines of the given line's own ring: their bins lie beside each other.
  StationaryNeighbours(const StationaryPoints& points, const LinePool& pool, std::size_t line,
                       const StationaryPatchOptions& options);
  StationaryNeighbours(const StationaryNeighbours&) = delete;
  StationaryNeighbours& operator=(const StationaryNeighbours&) = delete;

  /// The lines next below and above a motor angle at a bin, both with a point there and within reach.
  struct Pair {
    bool found = false;
    std::size_t below = 0, above = 0;  // cells
  };
  Pair bracket(double angle_rad, std::size_t bin);
  /// The cells whose points make the patch at a motor angle and a bin. Valid until the next call.
  std::span<const std::size_t> around(double angle_rad, std::size_t bin);
  StationaryPatch patch(double angle_rad, std::size_t bin, double range_m);

 private:
  struct Side {
    int lines = 0, points = 0;
    double away_rad = 0;  // the points' distances in motor angle, summed
  };
  void seek(double angle_rad, std::size_t bin);
  std::pair<Side, Side> collect_around(double angle_rad, std::size_t bin);  // below and above
  std::size_t cell(std::size_t place, std::size_t bin) const { return pool_[place] * points_.bins + bin; }
  Side collect(double angle_rad, std::size_t bin, int step);

  const StationaryPoints& points_;
  std::span<const std::uint32_t> pool_;  // of the line's own ring
  const StationaryPatchOptions& options_;
  std::size_t next_ = 0;                  // the first of the pool's lines at or above the angle
  static constexpr int kBinsPerLine = 3;  // the bin of the point and those beside it
  std::array<std::size_t, std::size_t{2} * kMaxLinesPerSide * kBinsPerLine> near_;
  std::size_t count_ = 0;
};

}  // namespace sweepscope
