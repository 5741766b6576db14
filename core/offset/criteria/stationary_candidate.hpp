#pragma once

// The mathematics: docs/algorithms.md, section 5.1.

#include <optional>
#include <vector>

#include "core/loam/odometry.hpp"
#include "core/offset/prepared/curve_point.hpp"

namespace sweepscope {

/// One pair of consecutive sweeps, registered: the motion that odometry sees at a candidate offset.
struct PairMotion {
  std::size_t sweep = 0;  // the first sweep's index
  bool succeeded = false;
  double translation_m = 0;        // equation 1
  double rotation_rad = 0;         // equation 2
  double signed_rotation_rad = 0;  // about the motor's axis, positive where the offset is too large
};

/// Registers every pair of consecutive sweeps rigidly at an offset. Pairs with a sweep shorter than a quarter
/// of the median are left out.
std::vector<PairMotion> pair_motions(const OffsetProblem& problem, double offset_s,
                                     const OdometryOptions& options);

/// The paper's criterion of section 3.2 at a candidate offset: d of equation 3, t, theta and the signed
/// alternating roll as means over `pairs` (the sweeps that they begin with), all absent where one of them
/// could not be registered.
CurvePoint stationary_candidate(const OffsetProblem& problem, double offset_s,
                                const std::vector<std::size_t>& pairs, double weight_c,
                                const OdometryOptions& options);

}  // namespace sweepscope
