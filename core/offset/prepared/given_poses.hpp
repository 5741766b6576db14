#pragma once

#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace sweepscope {

/// A trajectory from elsewhere, to be used as a prior or as the truth.
struct GivenPoses {
  std::string file;  // for messages
  /// Of the base frame (world_from_base), at least two, ascending; times as Recording's, on a clock of their
  /// own that may be shifted against the laser's.
  std::vector<StampedPose> poses;
  bool trusted = false;  // the truth
};

}  // namespace sweepscope
