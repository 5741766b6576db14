#include "core/offset/search/stationary_fit.hpp"

#include <cmath>

#include "core/offset/search/coarse_search.hpp"

namespace sweepscope {

StationaryFit fit_stationary(const Recording& part, const Job& job) {
  constexpr double kNear_units = 5;  // the least squares only refines what the search found
  StationaryFit fit;
  const auto prepared = prepare(part, FeatureOptions{}, job);
  if (!prepared || prepared->motor.sweeps.size() < 2) return fit;
  const SearchScale scale = search_scale(prepared->motor);
  const auto [from_s, to_s, coarse] = search_by_default(*prepared, scale, job);
  if (!coarse.best || job.cancelled()) return fit;
  const OffsetProblem problem = problem_for(*prepared, from_s, to_s);
  StationaryDirectOptions options;
  options.resampling = Resampling::kNone;
  fit.direct = solve_stationary(stationary_grid(problem), coarse.offset_s(), options, job);
  const double away_s = std::abs(fit.direct.offset_s - coarse.offset_s());
  const bool near = away_s < kNear_units * scale.unit_s;
  const bool inside = *coarse.best > 0 && *coarse.best + 1 < coarse.curve.size();
  fit.fits = fit.direct.matches >= options.min_matches && near && inside;
  return fit;
}

}  // namespace sweepscope
