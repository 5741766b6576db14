#pragma once

#include <cstddef>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Whether the rig stood still. A wrong offset turns all sweeps of one direction alike, so sweeps of the same
/// direction (k and k + 2) fall on each other wherever nothing moved, whatever the offset.
struct MotionTest {
  std::size_t pairs = 0;  // compared; 0: the recording has no two whole sweeps of one direction
  std::size_t moved = 0;  // pairs that moved, or that could not be registered at all
  double median_translation_m = 0;
  double median_rotation_rad = 0;

  bool answered() const { return pairs > 0; }
  bool moving() const { return 4 * moved > pairs; }
};

/// Compares up to 16 pairs spread over the recording, with default options. Fails only where the job is
/// cancelled.
Result<MotionTest> test_motion(const Recording& recording, const Job& job);

}  // namespace sweepscope
