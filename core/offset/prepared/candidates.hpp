#pragma once

// The mathematics: docs/algorithms.md, section 5.3.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/prepared/curve_point.hpp"

namespace sweepscope {

/// Candidate offsets from `from_s` to `to_s` in steps, both ends included where a step falls on them.
struct OffsetRange {
  double from_s = 0, to_s = 0, step_s = 0;  // both ends included
};

/// The paper's search: `steps` candidates besides the initial one, at initial + accuracy, initial - accuracy,
/// initial + 2 accuracy, ...
struct OffsetsAround {
  double initial_s = 0, accuracy_s = 0;  // the candidate in the middle; the step
  int steps = 0;                         // the number of candidates less one
};

/// All candidates of the ranges, ascending, each distinct offset once. Offsets are whole nanoseconds, so that
/// ranges that share an offset share it to the last bit.
std::vector<double> offsets_of(const std::vector<OffsetRange>& ranges);
/// The same candidates as a range.
OffsetRange range_around(const OffsetsAround& around);

/// Computes one candidate.
using Candidate = std::function<CurvePoint(double offset_s, const Job& job)>;

/// Computes candidates in parallel and keeps the curve ascending; offsets that are already there are not
/// computed again. The same bytes for any number of threads. On interruption the curve keeps the finished
/// candidates.
class Curve {
 public:
  /// Of a function that computes the criteria at an offset. It is called from several threads.
  explicit Curve(Candidate candidate) : candidate_(std::move(candidate)) {}

  /// False if the job was cancelled.
  bool compute(const std::vector<double>& offsets_s, const Job& job);
  /// What has been computed, by ascending offset.
  const std::vector<CurvePoint>& points() const { return points_; }

 private:
  Candidate candidate_;
  std::vector<CurvePoint> points_;
};

/// Both curves as one, ascending; where both have an offset the first one's point.
std::vector<CurvePoint> united(std::vector<CurvePoint> curve, const std::vector<CurvePoint>& more);

/// A value that a point of a curve may hold.
using CurveValue = std::optional<double> CurvePoint::*;
/// The index of the smallest of the present values; the size of the curve where there is none.
std::size_t index_of_min(const std::vector<CurvePoint>& curve, CurveValue value);
/// The same for the largest value.
std::size_t index_of_max(const std::vector<CurvePoint>& curve, CurveValue value);

/// A second-degree fit over a part of a curve, with x = (offset - centre) / reach. n falls off as a parabola,
/// n = scale (c0 + c1 x + c2 x^2). Distances go as a hyperbola: d, e and the capped cost are fitted by their
/// squares, each divided by the distance, value = scale sqrt(c0 + c1 x + c2 x^2).
struct ExtremumFit {
  bool of_squares = false;                   // fitted to the squares of the values
  double centre_s = 0, reach_s = 1;          // x = (offset - centre) / reach
  double scale = 1, c0 = 0, c1 = 0, c2 = 0;  // value = scale (c0 + c1 x + c2 x^2)
  double from_s = 0, to_s = 0;               // the first and last offset of the points that it was fitted to

  /// The fitted value.
  double at(double offset_s) const;
  /// The offset of the minimum or maximum.
  double extremum_s() const { return centre_s - c1 / (2 * c2) * reach_s; }
};

/// The fit to the values within `reach_s` of point `best`; absent where `fitted_extremum` says it fails.
std::optional<ExtremumFit> fit_of_extremum(const std::vector<CurvePoint>& curve, CurveValue value,
                                           std::size_t best, double reach_s);

/// The fit that gave this optimum of the curve, looked for among all reaches (an estimate does not hold its
/// own). None where no fit has its extremum there: then the optimum is a grid point.
std::optional<ExtremumFit> fit_behind(const std::vector<CurvePoint>& curve, CurveValue value,
                                      const CriterionOptimum& optimum);

/// The extremum of the second-degree fit to the contiguous present values within `reach_s` of point `best`
/// (the authors' 2018 follow-up), with the value of the point nearest to it. They reach as far to one side as
/// to the other, unless fewer than 5 would be left. Where they are fewer than 5, or the fit bends the wrong
/// way or has its extremum outside them, those within twice the reach are used; where that fails too, the
/// grid point itself is the result.
CriterionOptimum fitted_extremum(const std::vector<CurvePoint>& curve, CurveValue value, std::size_t best,
                                 double reach_s);

}  // namespace sweepscope
