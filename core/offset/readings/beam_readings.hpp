#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <vector>

#include "core/job.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// How the beams of a 2D scanner's message may follow each other in time: as recorded, in the opposite order,
/// all at once, or in the time that a mirror takes which turns once a scan, or that passes from scan to scan.
/// Readings that hardly differ are listed once; the recorded one is the first.
std::vector<BeamReading> possible_readings(const Recording& recording);

/// The recording as another reading has it: times of beams, and their order, change.
Recording read_as(const Recording& recording, double time_increment_s);

/// Ranks the readings of a recording by how well sweeps of opposite directions fit each other: for a
/// stationary rig, a wrong reading leaves distances that no offset removes. Each costs a coarse search and a
/// small least squares on the first sweeps; the recorded one alone is tried where it fits. The one to be used
/// is `chosen`. Empty where nothing is decided: a 3D scanner, a moving rig, too few sweeps.
std::vector<BeamReading> rank_readings(const Recording& recording, const Job& job);

}  // namespace sweepscope
