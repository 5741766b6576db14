#pragma once

// The mathematics: docs/algorithms.md, sections 7 and 8.

#include <memory>
#include <optional>

#include "core/job.hpp"
#include "core/offset/search/coarse_search.hpp"
#include "core/offset/stationary/direct_stationary.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// A coarse search of a few sweeps, as if the rig was stationary. It compares ranges at equal angles of the
/// motor, whatever axis that turns about.
struct StationarySearch {
  PreparedRecording prepared;
  SearchScale scale;
  SearchedWindow window;  // with a best candidate
};
/// The default search of a part of a recording; absent where sweeps are too few or nowhere overlap.
std::optional<StationarySearch> search_stationary(std::shared_ptr<const Recording> part,
                                                  const FeatureOptions& options, const Job& job);

/// What such a search and a least squares without resampling say.
struct StationaryFit {
  StationaryDirect direct;
  bool fits = false;  // enough matches, and an offset within the window near the coarse one
};
/// Of a motor that turns about this axis.
StationaryFit fit_about(const Eigen::Vector3d& axis, const StationarySearch& search, const Job& job);
/// Search and fit by the recording's own axis.
StationaryFit fit_stationary(const Recording& part, const Job& job);

/// The same recording and features, of a motor that turns about this axis.
PreparedRecording turned_about(const Eigen::Vector3d& axis, PreparedRecording prepared);

}  // namespace sweepscope
