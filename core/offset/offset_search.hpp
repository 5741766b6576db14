#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/offset/coarse_search.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimate_options.hpp"
#include "core/offset/rig_motion.hpp"
#include "core/offset/search_window.hpp"
#include "core/offset/still_points.hpp"

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
  const StillGrid& grid;
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

/// The result of one method. The offset is identifiable if there are no reasons against it.
struct Answer {
  std::optional<double> offset_s, sigma_s, drift_ppm;
  std::vector<CriterionOptimum> criteria;
  std::vector<CurvePoint> curve;
  std::vector<Interval> lost;
  std::optional<UsedMotion> motion;
  std::optional<FitEvidence> fit;
  std::vector<SigmaPart> sigma_parts;
  std::optional<RigEffects> rig_effects;
  std::shared_ptr<const SolvedWalk> walk;
  std::optional<OffsetOverTime> over_time;
  std::vector<std::string> warnings, reasons;
};

}  // namespace sweepscope
