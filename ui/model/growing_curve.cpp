#include "ui/model/growing_curve.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope::ui {
namespace {

/// Whether a candidate has values of a method, besides the capped cost of the coarse search.
bool has_criteria(const CurvePoint& point) {
  return point.d || point.e_m || point.n;
}

}  // namespace

void GrowingCurve::begin() {
  const std::lock_guard lock(mutex_);
  searches_.emplace_back();
}

void GrowingCurve::add(const CurvePoint& point) {
  if (std::abs(point.offset_s) > reach_s_ && !has_criteria(point)) return;
  const std::lock_guard lock(mutex_);
  searches_.back().push_back(point);
}

std::size_t GrowingCurve::size() const {
  const std::lock_guard lock(mutex_);
  std::size_t count = 0;
  for (const auto& search : searches_) count += search.size();
  return count;
}

/// The last one first: a candidate that is computed again, of all of a recording rather than of a sample of
/// its sweeps, replaces what it was.
std::vector<CurvePoint> GrowingCurve::candidates(bool of_method) const {
  std::vector<CurvePoint> found;
  if (of_method) {
    for (auto search = searches_.rbegin(); search != searches_.rend(); ++search)
      std::copy_if(search->rbegin(), search->rend(), std::back_inserter(found), has_criteria);
    return found;
  }
  auto shown = searches_.rbegin();
  for (auto before = shown + 1; before != searches_.rend() && 2 * shown->size() < before->size(); ++before)
    shown = before;
  found.assign(shown->rbegin(), shown->rend());
  return found;
}

Estimate GrowingCurve::so_far() const {
  Estimate estimate;
  {
    const std::lock_guard lock(mutex_);
    estimate.curve = candidates(true);
    estimate.method = estimate.curve.empty() ? Method::kDirect : Method::kMoving;
    if (estimate.curve.empty()) estimate.curve = candidates(false);
  }
  std::stable_sort(estimate.curve.begin(), estimate.curve.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.offset_s < b.offset_s; });
  // The parts of a recording share their candidates.
  const auto same = [](const CurvePoint& a, const CurvePoint& b) { return a.offset_s == b.offset_s; };
  estimate.curve.erase(std::unique(estimate.curve.begin(), estimate.curve.end(), same), estimate.curve.end());
  return estimate;
}

}  // namespace sweepscope::ui
