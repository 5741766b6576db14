#pragma once

#include <vector>

#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/prepared/options.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "core/offset/search/coarse_search.hpp"
#include "core/offset/stationary/stationary_points.hpp"

namespace sweepscope {

/// The candidate offsets of a search, ascending.
struct SearchWindow {
  std::vector<double> offsets_s;
  bool by_default = true;  // the default window, in steps of a unit
  double from_s() const { return offsets_s.front(); }
  double to_s() const { return offsets_s.back(); }
  double middle_s() const { return (from_s() + to_s()) / 2; }
};

/// What is known about a recording before its offset: the input of both kinds of methods. `problem`,
/// `grid` and `options` must outlive it.
struct OffsetSearch {
  const OffsetProblem& problem;
  const StationaryGrid& grid;
  const EstimateOptions& options;
  SearchScale scale;
  SearchWindow window;
  CoarseSearch coarse;
  MotionTest motion;
  RigKind kind = RigKind::kStationary;
  Method method = Method::kDirect;

  /// The kind of rig that the sweeps are treated as.
  bool as_moving() const {
    return method == Method::kDirect ? kind == RigKind::kMoving : method == Method::kMoving;
  }
  double recorded_s() const {
    const auto& scans = problem.recording->scans;
    return scans.back().first_beam_s - scans.front().first_beam_s;
  }
};

}  // namespace sweepscope
