#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/worlds/walk.hpp"

namespace sweepscope::simulation {

/// How the carrier of a rig goes this time.
struct Carriage {
  double duration_s = 60, cruise_mps = 1;
  double begins_s = 0;     // stationary for so long at first; 0: in motion from the start
  std::uint64_t seed = 1;  // of changes of speed and of rests
};

/// Where the carrier is.
struct Stride {
  double t_s = 0, speed_mps = 0;
  Vector3d foot_m = Vector3d::Zero();  // on the floor
  Vector2d forward = Vector2d::UnitX();
  bool arrived = false;  // at the end of the way
};

/// A person who follows a way, every 10 ms: steers for a point ahead of him, slows down where the way bends
/// and where he does not face it, and stops at its end.
std::vector<Stride> walk_along(const std::vector<Vector3d>& way, const WalkStyle& style,
                               const Carriage& carriage);

}  // namespace sweepscope::simulation
