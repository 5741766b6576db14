#include "core/offset/coarse_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/candidates.hpp"
#include "core/offset/direct_stationary.hpp"
#include "core/offset/prepared.hpp"

namespace sweepscope {
namespace {

// 20 s of sweeps of 0.5 s, so that the cost ends growing with the length. More would not move the valley by
// a unit.
constexpr std::size_t kMaxSweeps = 40;

std::vector<double> every_second(const std::vector<double>& offsets_s) {
  std::vector<double> chosen_s;
  for (std::size_t i = 0; i < offsets_s.size(); i += 2) chosen_s.push_back(offsets_s[i]);
  if (chosen_s.back() != offsets_s.back()) chosen_s.push_back(offsets_s.back());
  return chosen_s;
}

}  // namespace

CoarseSearch search_coarsely(const OffsetProblem& problem, double from_s, double to_s,
                             const SearchScale& scale, const Job& job,
                             const std::function<void(const CurvePoint&)>& finished) {
  const double middle_s = (from_s + to_s) / 2;
  const OffsetProblem part = problem.motor.one_way() ? beginnings_of_sides(problem, middle_s, kMaxSweeps / 2)
                                                     : beginning_of(problem, middle_s, kMaxSweeps);
  const StillGrid grid = still_grid(part);
  CoarseSearch search;
  const auto compute = [&](const std::vector<double>& offsets_s) {
    search.curve = united(std::move(search.curve), stationary_coarse_curve(grid, offsets_s, job, finished));
    const std::size_t best = index_of_min(search.curve, &CurvePoint::capped_cost_m);
    if (best < search.curve.size()) search.best = best;
  };
  const std::vector<double> all_s = offsets_of({{from_s, to_s, scale.unit_s}});
  compute(every_second(all_s));
  if (!search.best) return search;
  const double best_s = search.offset_s();
  std::vector<double> beside_s;
  const auto is_computed = [&](double offset_s) {
    return std::any_of(search.curve.begin(), search.curve.end(),
                       [&](const CurvePoint& point) { return point.offset_s == offset_s; });
  };
  for (const double offset_s : all_s)
    if (std::abs(offset_s - best_s) < 1.5 * scale.unit_s && !is_computed(offset_s))
      beside_s.push_back(offset_s);
  compute(beside_s);
  return search;
}

}  // namespace sweepscope
