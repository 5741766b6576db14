#pragma once

#include <vector>

#include "core/simulation/motion/plan_curve.hpp"

namespace sweepscope::simulation {

/// The distance along a curve over time of a walk from rest to rest: slower in bends, fastest on the
/// straightest stretch.
class SpeedProfile {
 public:
  struct Limits {
    double duration_s = 0;
    double top_speed_mps = 0;
    double top_turn_rate_radps = 0;  // about z, from speed and curvature
  };
  /// Throws std::invalid_argument if the curve cannot be walked within the limits.
  SpeedProfile(const PlanCurve& curve, const Limits& limits);

  struct Progress {
    double distance_m = 0, speed_mps = 0;
  };
  Progress at(double t_s) const;

 private:
  std::vector<double> distance_m_, speed_mps_;  // every kStep_s
};

}  // namespace sweepscope::simulation
