#pragma once

#include <cstddef>

#include "core/loam/odometry.hpp"

namespace sweepscope {

/// Whether the rig stood still. A wrong offset turns all sweeps of one direction alike, so sweeps of the same direction
/// (k and k + 2) fall on each other wherever nothing moved, whatever the offset.
struct MotionTest {
  std::size_t pairs = 0;        // compared; 0: the recording has no two whole sweeps of one direction
  std::size_t moved = 0;        // pairs that moved, or that could not be registered at all
  double median_translation_m = 0;
  double median_rotation_rad = 0;

  bool answered() const { return pairs > 0; }
  bool moving() const { return 4 * moved > pairs; }
};

/// Compares up to 16 pairs spread over the sweeps placed at any one offset.
MotionTest test_motion(const std::vector<PlacedSweep>& sweeps, const MotorMotion& motor,
                       const OdometryOptions& options);

/// The same for a recording as it is, with default options. Fails only where the job is cancelled.
Result<MotionTest> test_motion(const Recording& recording, const Job& job);

}  // namespace sweepscope
