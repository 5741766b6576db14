#pragma once

// The mathematics: docs/algorithms.md, section 19, "Another way".

#include <optional>
#include <string>
#include <vector>

#include "core/offset/walk/walk.hpp"

namespace sweepscope {

/// The same walk, tracked in several ways.
struct WalkWays {
  std::vector<SolvedWalk> walks;
  std::size_t independent = 0;  // so many of the first ones are nowhere the motion of another
};

/// A solved walk, and the same walk tracked in other ways. Two differ from it in directions that surfaces
/// hardly determine: higher speeds are as likely. Others begin at other places, two of those that were tried
/// each. Further ones go on from the sweeps that two ways agree about, on the map of these, as long as those
/// become more. Absent if the job was cancelled. The same bytes for any number of threads.
std::optional<WalkWays> ways_to_track(const OffsetProblem& problem, const SolvedWalk& walk,
                                      const MappingOptions& mapping, const Job& job);

/// The way whose features fit each other best.
const SolvedWalk& best_fitting(const WalkWays& ways);

/// The most sweeps in a row of the best fitting way that another one confirms; none if there are none.
KnownSweeps certain_sweeps(const WalkWays& ways);

/// A sentence about the part of a walk, one of the ways, that no independent one confirms and that ends
/// farthest from the nearest of them; empty where that is within `limit_m`. The first and the last sweep
/// alone, which hold few scans, are not such a part.
std::string contradiction_of(const SolvedWalk& walk, const WalkWays& ways, double limit_m,
                             const Recording& recording);

}  // namespace sweepscope
