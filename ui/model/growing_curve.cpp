#include "ui/model/growing_curve.hpp"

#include <algorithm>

namespace sweepscope::ui {
namespace {

/// Whether a candidate has values of a method, besides the capped cost of the coarse search.
bool has_criteria(const CurvePoint& point) {
  return point.d || point.e_m || point.n;
}

}  // namespace

void GrowingCurve::add(const CurvePoint& point) {
  const std::lock_guard lock(mutex_);
  points_.push_back(point);
}

std::size_t GrowingCurve::size() const {
  const std::lock_guard lock(mutex_);
  return points_.size();
}

Estimate GrowingCurve::so_far() const {
  Estimate estimate;
  {
    const std::lock_guard lock(mutex_);
    // The last one first: a candidate that is computed again, of all of a recording rather than of a sample
    // of its sweeps, replaces what it was.
    estimate.curve.assign(points_.rbegin(), points_.rend());
  }
  const bool by_method = std::any_of(estimate.curve.begin(), estimate.curve.end(), has_criteria);
  if (by_method) std::erase_if(estimate.curve, [](const CurvePoint& point) { return !has_criteria(point); });
  estimate.method = by_method ? Method::kMoving : Method::kDirect;
  std::stable_sort(estimate.curve.begin(), estimate.curve.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.offset_s < b.offset_s; });
  // The parts of a recording share their candidates.
  const auto same = [](const CurvePoint& a, const CurvePoint& b) { return a.offset_s == b.offset_s; };
  estimate.curve.erase(std::unique(estimate.curve.begin(), estimate.curve.end(), same), estimate.curve.end());
  return estimate;
}

}  // namespace sweepscope::ui
