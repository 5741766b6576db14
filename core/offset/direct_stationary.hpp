#pragma once

// The mathematics: docs/algorithms.md, section 8.

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/still_points.hpp"
#include "core/offset/uncertainty.hpp"

namespace sweepscope {

/// The offset of a standing rig as the one unknown of a least squares.
///
/// A point p on a line of one direction lies at distance r = n . (p - c) from a patch (c, n) of the other's.
/// An offset that grows turns the point by omega_p and the patch by omega_c about the motor's axis a, so
///   dr / d offset = (omega_p - omega_c) n . (a x p),
/// and Gauss-Newton's step is - sum w r J / sum w J^2, with Cauchy weights w.
/// What is solved anew to see how sure the answer is: everything, or parts of the sweeps alone, at half the
/// cost.
enum class Resampling { kAll, kParts };

struct StationaryDirectOptions {
  int max_iterations = 10;
  double step_tolerance_s = 1e-6;
  double first_loss_width_m = 0.1;  // later: `loss_widths` times the residuals' robust deviation
  double loss_widths = 2.5;
  double min_loss_width_m = 0.004;
  std::size_t min_matches = 100;
  Resampling resampling = Resampling::kAll;
};

/// A point against a patch of the other direction, at one offset.
struct PatchDistance {
  double jacobian_m_s = 0, distance_m = 0;  // dr / d offset and r
  float lever_m = 0, reach_m = 0;           // n . (a x p) and |a x p|
};
PatchDistance distance_to_patch(const StillPatch& patch, const Eigen::Vector3d& p_m, double speed_rad_s,
                                const Eigen::Vector3d& motor_axis);

/// Mean difference of range between the directions at each candidate offset, each at most a cap: needs no
/// registration and so is right far from the valley too. Absent where the directions hardly overlap.
std::vector<CurvePoint> stationary_coarse_curve(const StillGrid& grid, const std::vector<double>& offsets_s,
                                                const Job& job);

/// The answer and what it rests on.
struct StationaryDirect {
  bool converged = false;
  double offset_s = 0;
  double step_s = 0;  // the last one
  int iterations = 0;
  std::size_t features = 0, matches = 0;
  double middle_s =
      0;  // laser clock, mean time of the matches by their weight: where a drifting offset is right
  double residual_m = 0;  // robust deviation of the distances
  double lever_m = 0;     // rms of n . (a x p): by how much a turn of 1 rad lifts the points off the patches
  double reach_m = 0;     // rms of |a x p|: as far as they could be lifted
  // Resampling: the recording is cut into parts, blocks of sweeps in the order of time, or sectors of the
  // motor's angle where sweeps are few.
  std::vector<WithoutPart> without_part;  // the offset without each part
  std::vector<WithoutPart> without_comb;  // the same for combs of lines, every so many-th one
  std::vector<double> block_s,
      block_offset_s;  // blocks of sweeps: middle and the offset each asks for by itself
};

StationaryDirect solve_stationary(const StillGrid& grid, double first_offset_s,
                                  const StationaryDirectOptions& options, const Job& job);

/// How far the answer may be off, as far as what was resampled and the recording's stamps tell: the greatest
/// of what parts, combs and `stamps_sigma_s` say. Absent where the parts are too few.
std::optional<double> sigma_of(const StationaryDirect& found, const Recording& recording);

}  // namespace sweepscope
