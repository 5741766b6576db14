#pragma once

#include <optional>
#include <string>

namespace sweepscope {

/// What was computed at one candidate offset. A value is absent if the method has no such criterion or the
/// registration failed; a failed candidate never wins.
struct CurvePoint {
  double offset_s = 0;                        // the candidate
  std::optional<double> d;                    // equation 3, mean over the pairs of sweeps
  std::optional<double> translation_m;        // equation 1, mean over the pairs of sweeps
  std::optional<double> rotation_rad;         // equation 2, mean over the pairs of sweeps
  std::optional<double> signed_rotation_rad;  // about the motor's axis, alternating in sign; 0 at the offset
  std::optional<double> n;                    // equation 6, matches
  std::optional<double> e_m;                  // equation 7, mean distance per match
  std::optional<double> capped_cost_m;  // mean distance over a fixed set of features, in which a miss pays
                                        // the cap
};

/// Where one criterion has its extremum, and its value there.
struct CriterionOptimum {
  std::string name;     // "d", "n", "e", "capped_cost" or "direct"
  double offset_s = 0;  // of the extremum, between candidates if it was fitted
  double value = 0;     // in the unit of CurvePoint
};

}  // namespace sweepscope
