#include "core/offset/search/stationary_fit.hpp"

#include <cmath>

namespace sweepscope {

PreparedRecording turned_about(const Eigen::Vector3d& axis, PreparedRecording prepared) {
  if (prepared.recording->rig.mount.axis == axis) return prepared;
  auto turned = std::make_shared<Recording>(*prepared.recording);
  turned->rig.mount.axis = axis;
  prepared.recording = std::move(turned);
  return prepared;
}

std::optional<StationarySearch> search_stationary(std::shared_ptr<const Recording> part,
                                                  const FeatureOptions& options, const Job& job) {
  auto prepared = prepare(std::move(part), options, job);
  if (!prepared || prepared->motor.sweeps.size() < 2) return std::nullopt;
  const SearchScale scale = search_scale(prepared->motor);
  SearchedWindow window = search_by_default(*prepared, scale, job);
  if (!window.coarse.best || job.cancelled()) return std::nullopt;
  return StationarySearch{std::move(*prepared), scale, std::move(window)};
}

StationaryFit fit_about(const Eigen::Vector3d& axis, const StationarySearch& search, const Job& job) {
  constexpr double kNear_units = 5;  // the least squares only refines what the search found
  const CoarseSearch& coarse = search.window.coarse;
  const PreparedRecording turned = turned_about(axis, search.prepared);
  const OffsetProblem problem = problem_for(turned, search.window.from_s, search.window.to_s);
  StationaryDirectOptions options;
  options.resampling = Resampling::kNone;
  StationaryFit fit{solve_stationary(stationary_grid(problem), coarse.offset_s(), options, job), false};
  const double away_s = std::abs(fit.direct.offset_s - coarse.offset_s());
  const bool near = away_s < kNear_units * search.scale.unit_s;
  const bool inside = *coarse.best > 0 && *coarse.best + 1 < coarse.curve.size();
  fit.fits = fit.direct.matches >= options.min_matches && near && inside;
  return fit;
}

StationaryFit fit_stationary(const Recording& part, const Job& job) {
  const auto search = search_stationary(borrowed(part), FeatureOptions(), job);
  return search ? fit_about(part.rig.mount.axis, *search, job) : StationaryFit();
}

}  // namespace sweepscope
