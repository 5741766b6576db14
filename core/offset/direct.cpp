#include "core/offset/direct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/candidates.hpp"
#include "core/offset/direct_moving.hpp"
#include "core/offset/direct_stationary.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/uncertainty.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kCoarseSweeps = 40;

void add(std::vector<std::string>& to, const Remark& remark) {
  if (remark) to.push_back(*remark);
}

double duration_s(const OffsetProblem& problem) {
  const auto& scans = problem.recording->scans;
  return scans.back().first_beam_s - scans.front().first_beam_s;
}

// Every second of the window's candidates, then those beside the best.
std::vector<double> every_second(const std::vector<double>& offsets_s) {
  std::vector<double> chosen_s;
  for (std::size_t i = 0; i < offsets_s.size(); i += 2) chosen_s.push_back(offsets_s[i]);
  if (chosen_s.back() != offsets_s.back()) chosen_s.push_back(offsets_s.back());
  return chosen_s;
}

void sort_into(std::vector<CurvePoint>& curve, const std::vector<CurvePoint>& more) {
  for (const CurvePoint& point : more)
    if (std::none_of(curve.begin(), curve.end(), [&](const auto& p) { return p.offset_s == point.offset_s; }))
      curve.push_back(point);
  std::sort(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.offset_s < b.offset_s; });
}

// Between neighbouring candidates the halves must agree, or the scatter hides something.
std::optional<double> widened_by_halves(std::optional<double> sigma_s, const std::vector<double>& series_s,
                                        Estimate& result) {
  if (!sigma_s || series_s.size() < 4) return sigma_s;
  double halves_s[2] = {0, 0};
  const std::size_t middle = series_s.size() / 2;
  for (std::size_t i = 0; i < series_s.size(); ++i)
    halves_s[i < middle ? 0 : 1] += series_s[i] / double(i < middle ? middle : series_s.size() - middle);
  const double half_apart_s = std::abs(halves_s[1] - halves_s[0]) / 2;
  if (half_apart_s < 3 * *sigma_s) return sigma_s;
  result.warnings.push_back(fmt::format("The halves of the recording disagree: {:.3f} ms and {:.3f} ms.",
                                        halves_s[0] * 1e3, halves_s[1] * 1e3));
  return half_apart_s;
}

void answer(double offset_s, std::optional<double> sigma_s, double value, const SearchScale& scale,
            const std::vector<double>& window_s, Estimate& result) {
  result.criteria.push_back({"direct", offset_s, value});
  if (offset_s < window_s.front() || offset_s > window_s.back())
    result.reasons.push_back(fmt::format(
        "The offset would lie beyond the edge of the searched range, at {:.1f} ms.", offset_s * 1e3));
  add(result.reasons, sigma_reason(sigma_s, scale));
  result.identifiable = result.reasons.empty();
  if (!result.identifiable) return;
  result.offset_s = offset_s;
  result.sigma_s = sigma_s;
}

void judge_drift(const std::optional<Trend>& trend, double recorded_s, std::optional<double> sigma_s,
                 Estimate& result) {
  if (!trend) return;
  result.drift_ppm = trend->slope * 1e6;
  add(result.reasons, drift_reason(*trend, recorded_s, sigma_s.value_or(0)));
}

// Matches come and go, so that the last steps may go to and fro: by less than sigma they leave an answer.
void judge_convergence(bool converged, double last_step_s, double sigma_s, Estimate& result) {
  if (converged) return;
  const bool small = std::abs(last_step_s) < sigma_s;
  (small ? result.warnings : result.reasons).push_back("The least squares did not converge.");
}

// What the motion of a rig that is treated as stationary leaves uncertain. From one sweep to the next it
// moves half as far as to the next but one, and an error of the offset turns the two against each other by
// twice the motor's speed times it; motion one way and the other averages out over the pairs.
double motion_sigma_s(const MotionTest& motion, double lever_m, double speed_rad_s) {
  if (!motion.moving()) return 0;
  return motion.median_apart_m / 2 / (2 * speed_rad_s * lever_m) /
         std::sqrt(double(std::max<std::size_t>(1, motion.pairs)));
}

Remark motion_reason(double sigma_s, const SearchScale& scale) {
  if (sigma_s < scale.unit_s) return std::nullopt;
  return fmt::format(
      "The rig moved too far from sweep to sweep to be treated as stationary: that alone leaves the offset "
      "uncertain by +- {:.1f} ms.",
      sigma_s * 1e3);
}

void estimate_standing(const OffsetProblem& problem, double coarse_s, const std::vector<double>& window_s,
                       const SearchScale& scale, const MotionTest& motion, const Job& job, Estimate& result) {
  const StillGrid grid = still_grid(problem);
  const StationaryDirect found = solve_stationary(grid, coarse_s, {}, job);
  if (job.cancelled()) return;
  if (found.matches < StationaryDirectOptions().least_matches) {
    result.reasons.push_back(fmt::format("Only {} of {} points lie on surfaces that the other direction saw.",
                                         found.matches, found.features));
    return;
  }
  add(result.reasons, lever_reason(found.lever_m, found.reach_m));
  add(result.warnings, few_matches_warning(found.matches, found.features));
  std::optional<double> sigma_s = sigma_of(found, *problem.recording);
  judge_convergence(found.converged, found.step_s, sigma_s.value_or(0), result);
  if (sigma_s)
    sigma_s = std::hypot(*sigma_s, unseen_sigma_s(*problem.recording, problem.motor, found.offset_s));
  const double of_motion_s = motion_sigma_s(motion, found.lever_m, problem.motor.median_speed_rad_s);
  if (const auto moved_far = motion_reason(of_motion_s, scale))
    result.reasons.push_back(*moved_far);
  else if (sigma_s)
    sigma_s = std::hypot(*sigma_s, of_motion_s);
  judge_drift(trend_of(found.block_s, found.block_offset_s), duration_s(problem), sigma_s, result);
  sigma_s = widened_by_halves(sigma_s, found.block_offset_s, result);
  answer(found.offset_s, sigma_s, found.residual_m, scale, window_s, result);
}

void judge_walk(const MovingDirect& found, Estimate& result) {
  const JointWalk& walk = *found.walk.joint;
  judge_convergence(found.converged, walk.step_s, walk.sigma_s, result);
  add(result.reasons, lever_reason(walk.lever_m, walk.reach_m));
  const auto &below = found.curve.front().e_m, &here = found.curve[1].e_m, &above = found.curve.back().e_m;
  if (!here)
    result.reasons.push_back("The map holds no matches at the offset that fits the walk best.");
  else if ((below && *below < *here) || (above && *above < *here))
    result.reasons.push_back(fmt::format(
        "The map is not clearest at the offset that fits the walk best: e is {:.1f} mm there, and {:.1f} and "
        "{:.1f} mm to its sides.",
        *here * 1e3, below.value_or(0) * 1e3, above.value_or(0) * 1e3));
}

// A body that sways in step with the motor looks much like an offset.
void warn_of_sway(double sway_rad, Estimate& result) {
  constexpr double kUsual_rad = 0.014;  // of any walk: the sweeps' own scatter
  if (sway_rad < kUsual_rad) return;
  result.warnings.push_back(fmt::format(
      "The trajectory turns to and fro in step with the motor, by {:.1f} deg from sweep to sweep: the rig "
      "swayed like that, or the sweeps have too little in common. Another pace or another "
      "motor speed would make the answer surer.",
      sway_rad * kDegPerRad));
}

// Why nothing can be said of a walk.
std::string missing_reason(const OffsetProblem& problem, const SolvedWalk& walk,
                           const std::optional<MotionSource>& source) {
  if (!walk.lost) return "Sweeps of opposite directions hardly see the same surfaces.";
  if (source && source->motion.is_truth())
    return fmt::format("{} covers too few sweeps of the recording.", source->name);
  return lost_reason(walk, *problem.recording);
}

Remark left_out_warning(const std::vector<Interval>& lost, const std::optional<MotionSource>& source) {
  const Remark warning = lost_warning(lost);
  if (!warning || !source || !source->motion.is_truth()) return warning;
  return fmt::format(
      "{} does not cover all scans: {} intervals are left out, the first from {:.1f} to {:.1f} s.",
      source->name, lost.size(), lost.front().begin_s, lost.front().end_s);
}

void estimate_walking(const OffsetProblem& problem, double coarse_s, const std::vector<double>& window_s,
                      const SearchScale& scale, const MappingOptions& mapping,
                      const std::optional<MotionSource>& source, const Job& job, Estimate& result) {
  const auto solved = solve_moving(problem, coarse_s, {walk_options(mapping, scale), 3 * scale.unit_s}, job);
  if (!solved) return;
  const MovingDirect& found = *solved;
  result.lost = lost_times(found.walk.sweeps, *problem.recording);
  if (found.walk.lost || !found.walk.joint) {
    result.reasons.push_back(missing_reason(problem, found.walk, source));
    return;
  }
  add(result.warnings, left_out_warning(result.lost, source));
  const JointWalk& walk = *found.walk.joint;
  if (source && walk.time_shift)
    result.motion = source->used(walk.time_shift);
  else if (source && mapping.given)
    result.warnings.push_back(
        fmt::format("{} is not used: the rig deviates from it less smoothly than it moves.", source->name));
  sort_into(result.curve, found.curve);
  judge_walk(found, result);
  std::vector<double> parts_offset_s;
  for (const JointWalkPart& part : walk.parts) parts_offset_s.push_back(part.offset_s);
  if (!source || !source->motion.is_truth()) warn_of_sway(found.sway_rad, result);
  std::optional<double> sigma_s =
      std::hypot(walk.sigma_s, unseen_sigma_s(*problem.recording, problem.motor, walk.offset_s));
  // Parts that tell nothing scatter as if the clocks drifted apart.
  if (!sigma_reason(sigma_s, scale)) judge_drift(drift_of(walk), duration_s(problem), walk.sigma_s, result);
  sigma_s = widened_by_halves(sigma_s, parts_offset_s, result);
  add(result.warnings, few_matches_warning(walk.matches, walk.features));
  answer(walk.offset_s, sigma_s, found.curve[1].e_m.value_or(0), scale, window_s, result);
}

}  // namespace

CoarseSearch search_coarsely(const OffsetProblem& problem, const std::vector<double>& window_s,
                             const SearchScale& scale, const Job& job) {
  const double middle_s = (window_s.front() + window_s.back()) / 2;
  const OffsetProblem part = beginning_of(problem, middle_s, kCoarseSweeps);
  const StillGrid grid = still_grid(part);
  CoarseSearch search;
  const auto compute = [&](const std::vector<double>& offsets_s) {
    sort_into(search.curve, stationary_coarse_curve(grid, offsets_s, job));
    const std::size_t best = index_of_least(search.curve, &CurvePoint::capped_cost_m);
    if (best < search.curve.size()) search.best = best;
  };
  const std::vector<double> all_s = offsets_of({{window_s.front(), window_s.back(), scale.unit_s}});
  compute(every_second(all_s));
  if (!search.best) return search;
  const double best_s = search.offset_s();
  std::vector<double> beside_s;
  for (const double offset_s : all_s)
    if (std::abs(offset_s - best_s) < 1.5 * scale.unit_s) beside_s.push_back(offset_s);
  compute(beside_s);
  return search;
}

Result<void> estimate_directly(const OffsetProblem& problem, const CoarseSearch& coarse, bool moving,
                               const MotionTest& motion, const MappingOptions& mapping,
                               const std::optional<MotionSource>& source, const Job& job, Estimate& result) {
  const SearchScale scale = search_scale(problem.motor);
  result.curve = coarse.curve;
  if (!coarse.best) {
    result.reasons.push_back(
        "Sweeps of opposite directions hardly see the same surfaces at any candidate offset.");
    return {};
  }
  const std::vector<double> window_s{coarse.curve.front().offset_s, coarse.curve.back().offset_s};
  add(result.reasons, beam_times_reason(*problem.recording, scale));
  // A walk blurs the valley of the coarse search: only the least squares tells whether there is one.
  if (!moving) {
    add(result.reasons, edge_reason(coarse.curve, *coarse.best));
    add(result.reasons, flat_reason(coarse.curve, *coarse.best));
    add(result.reasons, rival_reason(coarse.curve, *coarse.best, scale));
  }
  add(result.warnings, aliased_warning(*problem.recording, problem.motor));
  add(result.warnings, encoder_warning(problem.recording->motor));
  add(result.warnings, slow_motor_warning(problem.motor));
  if (!result.reasons.empty()) return {};
  if (!moving) {
    estimate_standing(problem, coarse.offset_s(), window_s, scale, motion, job, result);
    return {};
  }
  MappingOptions guided = mapping;
  if (source) {
    auto aligned = align_motion(problem, coarse.offset_s(), mapping, *source, job);
    if (!aligned) return tl::unexpected(aligned.error());
    guided.given = aligned->motion;
    for (std::string& warning : aligned->warnings) result.warnings.push_back(std::move(warning));
    result.motion = source->used(aligned->shift);
  }
  estimate_walking(problem, coarse.offset_s(), window_s, scale, guided, source, job, result);
  return {};
}

}  // namespace sweepscope
