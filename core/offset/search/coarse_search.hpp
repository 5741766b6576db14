#pragma once

// The mathematics: docs/algorithms.md, section 7.

#include <optional>
#include <vector>

#include "core/job.hpp"
#include "core/offset/prepared/curve_point.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/prepared/search_window.hpp"

namespace sweepscope {

/// The capped cost over a window of candidates, in steps of a unit: the ranges of neighbouring sweeps
/// compared at equal motor angle and beam, as if nothing had moved. On a walk motion blurs the valley, but
/// leaves it where it is. From the first 40 sweeps of the recording, each candidate computed once.
struct CoarseSearch {
  std::vector<CurvePoint> curve;  // ascending; capped_cost_m
  std::optional<std::size_t> best;
  double offset_s() const { return curve[*best].offset_s; }
  /// The best candidate, or where there is none another offset.
  double offset_or(double other_s) const { return best ? offset_s() : other_s; }
};
CoarseSearch search_coarsely(const OffsetProblem& problem, double from_s, double to_s,
                             const SearchScale& scale, const Job& job, const SearchWatch& watch = {});

/// The same in steps of four units, on the first twelve sweeps: a third of the cost of as wide a search.
CoarseSearch search_roughly(const OffsetProblem& problem, double from_s, double to_s,
                            const SearchScale& scale, const Job& job);

/// The best candidate is none of the ends and costs less than half of the usual one.
bool has_clear_valley(const CoarseSearch& search);

/// A search of the window that an estimate takes by default.
struct SearchedWindow {
  double from_s = 0, to_s = 0;
  CoarseSearch coarse;
};
/// The default window about 0. Where the cost has no clear valley there, and a lower one elsewhere, a window
/// as wide about the best of all offsets that can be distinguished (SearchScale::max_half_width_s).
SearchedWindow search_by_default(const PreparedRecording& prepared, const SearchScale& scale, const Job& job,
                                 const SearchWatch& watch = {});

}  // namespace sweepscope
