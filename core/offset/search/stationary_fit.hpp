#pragma once

// The mathematics: docs/algorithms.md, sections 7 and 8.

#include "core/job.hpp"
#include "core/offset/stationary/direct_stationary.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// What a coarse search and a least squares without resampling say of a few sweeps.
struct StationaryFit {
  StationaryDirect direct;
  bool fits = false;  // enough matches, and an offset within the window near the coarse one
};

/// The default search of a part of a recording, as if the rig was stationary.
StationaryFit fit_stationary(const Recording& part, const Job& job);

}  // namespace sweepscope
