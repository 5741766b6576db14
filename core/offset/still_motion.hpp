#pragma once

#include <optional>

#include "core/offset/motion_test.hpp"
#include "core/offset/still_points.hpp"

namespace sweepscope {

/// How one sweep lies against another of the same direction.
struct SweepShift {
  double translation_m = 0, rotation_rad = 0;
  double tilt_rad = 0;  // the rotation without its part about the motor's axis, where the clocks have a say
  std::size_t features = 0, matches = 0;
};

/// Registers the points of sweep `source` to the patches that those of sweep `target` form at the same motor
/// angles and beams. Absent where too few match. Directions that the scene does not tell are left at 0.
std::optional<SweepShift> shift_between(const StillPoints& points, const LinePool& target,
                                        const LinePool& source, const StillGrid& grid);

/// The motion test on the grid: pairs of sweeps of the same direction, k and k + 2, up to 16 spread over the
/// recording, at any one offset.
MotionTest test_motion(const StillGrid& grid, double offset_s);

/// How far the last whole sweep lies from the first of the same direction.
std::optional<SweepShift> shift_from_first_to_last(const StillGrid& grid, double offset_s);

}  // namespace sweepscope
