#pragma once

// The mathematics: docs/algorithms.md, section 9.

#include <vector>

#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/stationary/stationary_points.hpp"

namespace sweepscope {

/// The motion test on the grid, at any one offset.
///
/// A pair of sweeps moved where the shift between them has evidence: clearly more points on surfaces than at
/// rest. A long shift between sweeps that overlap too little for that counts where the next pair shows the
/// same one.
MotionTest test_motion(const StationaryGrid& grid, double offset_s);

/// Whether a test has too few pairs, so that `add_neighbours` should follow.
bool has_few_pairs(const MotionTest& test);

/// Adds the pairs of neighbouring sweeps, of opposite directions. `offset_s` must be the one at which these
/// fit best: a wrong one turns them against each other about the motor's axis, which is no motion.
void add_neighbours(const StationaryGrid& grid, double offset_s, MotionTest& test);

/// Whether a rig moved that seems stationary from sweep to sweep, since it began to within the first or the
/// last of them: of three groups of scan lines (motion_of_lines) that follow each other two moved. `offset_s`
/// as above. Not of motors that go in steps.
bool moved_within_sweeps(const StationaryGrid& grid, double offset_s);

/// The same evidence, pair by pair.
std::vector<MotionPart> motion_over_time(const StationaryGrid& grid, double offset_s);

/// The same evidence for groups of scan lines, an eighth of a sweep each, in the order of time: each is
/// compared with the two nearest sweeps of the other direction whose middles lie within `reference` (seconds
/// since the first scan). Groups with too few matches are left out, and all of a motor that turns one way.
/// `offset_s` as for `add_neighbours`.
std::vector<MotionPart> motion_of_lines(const StationaryGrid& grid, double offset_s,
                                        const RecordingPart& reference);

}  // namespace sweepscope
