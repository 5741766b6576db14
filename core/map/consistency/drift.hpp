#pragma once

// The mathematics: docs/algorithms.md, section 19.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/map/consistency/map_consistency.hpp"
#include "core/map/consistency/view_pair.hpp"

namespace sweepscope {

/// What the matches of one view with the surfaces of another show of the move between them.
struct FacedMove {
  std::size_t from = 0, to = 0;  // of the views
  WeakestDirection weakest;
};

/// The parts of a walk in which hardly a match faces the direction that the views show least, ascending
/// in time; times of the laser's clock. A move from a view to the next is shown also by a view beyond either
/// that is matched to the other.
std::vector<DriftingTime> drifting_times(const std::vector<WalkView>& views,
                                         const std::vector<FacedMove>& moves);

/// Absent if the standard deviation of the trajectory's error by each of them is at most `limit_m`. Otherwise
/// a sentence about the worst.
std::optional<std::string> drift_warning(const std::vector<DriftingTime>& drifting, double limit_m);

}  // namespace sweepscope
