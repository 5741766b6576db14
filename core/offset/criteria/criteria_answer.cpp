#include "core/offset/criteria/criteria_answer.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/judgement/evidence.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/stationary/direct_stationary.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

using enum RefusalKind;

CriterionOptimum named(const char* name, CriterionOptimum optimum) {
  optimum.name = name;
  return optimum;
}

// n's curve is flat: only tracking on LOAM's own poses may leave it undecided.
void compare_criteria(Answer& answer, double n_offset_s, double e_offset_s, const SearchScale& scale) {
  const double apart_s = std::abs(n_offset_s - e_offset_s);
  if (apart_s <= scale.unit_s) return;
  answer.limit_by(refusal(kCriteriaDisagree, apart_s / scale.unit_s, n_offset_s * 1e3, e_offset_s * 1e3),
                  apart_s > kLimits.max_criteria_apart_units * scale.unit_s);
}

// A wrong offset must turn the sweeps against each other by twice the motor's speed times the error. If
// it does not, the scene does not constrain the motor's angle. Seen within a few units of the best candidate:
// farther off sweeps are not registered.
MaybeRefusal rotation_refusal(const std::vector<CurvePoint>& curve, double offset_s, double unit_s,
                              double speed_rad_s) {
  constexpr double kNear_units = 10;
  double sx = 0, sy = 0, sxx = 0, sxy = 0, n = 0;
  for (const CurvePoint& point : curve) {
    if (!point.signed_rotation_rad || std::abs(point.offset_s - offset_s) > kNear_units * unit_s) continue;
    const double x = point.offset_s - curve.front().offset_s, y = *point.signed_rotation_rad;
    sx += x, sy += y, sxx += x * x, sxy += x * y, n += 1;
  }
  const double spread = sxx - sx * sx / std::max(1.0, n);
  if (n < 3 || !(spread > 0)) return std::nullopt;
  const double slope = (sxy - sx * sy / n) / spread / (2 * speed_rad_s);
  if (slope >= kLimits.min_roll_slope) return std::nullopt;
  return refusal(kRollDoesNotFollow, slope, slope);
}

MaybeRefusal apart_refusal(const CurvePoint& best) {
  if (*best.translation_m <= kLimits.max_sweeps_apart_m) return std::nullopt;
  return refusal(kSweepsApart, *best.translation_m, *best.translation_m);
}

// What the direct least squares, at the answer, says of it.
struct Certainty {
  std::optional<double> sigma_s;
  std::optional<Trend> drift;  // of the offset over the recording
  double drift_sigma_s = 0;    // of the offset that it is a drift of
};

// The spacing of the candidates about an offset.
double step_about(const std::vector<CurvePoint>& curve, double offset_s, double unit_s) {
  double min_s = unit_s;
  for (const CurvePoint& point : curve)
    if (point.offset_s != offset_s) min_s = std::min(min_s, std::abs(point.offset_s - offset_s));
  return min_s;
}

// The scatter of the single pairs of sweeps. Neighbouring pairs share a sweep, so the mean's variance is
// twice that of as many independent ones; the best of a grid of candidates adds the variance of its step.
std::optional<double> sigma_of_pairs(const OffsetSearch& search, const SharedByCandidates& shared,
                                     double offset_s, double step_s) {
  std::vector<double> errors_s;
  for (const PairMotion& motion : pair_motions(search.problem, offset_s, shared.odometry))
    if (std::find(shared.pairs.begin(), shared.pairs.end(), motion.sweep) != shared.pairs.end())
      errors_s.push_back(motion.signed_rotation_rad / (2 * search.problem.motor.median_speed_rad_s));
  const double n = static_cast<double>(errors_s.size());
  if (n < 3) return std::nullopt;
  double mean_s = 0, squares_s2 = 0;
  for (const double error_s : errors_s) mean_s += error_s / n;
  for (const double error_s : errors_s) squares_s2 += (error_s - mean_s) * (error_s - mean_s);
  return std::hypot(student_factor(n / 2) * std::sqrt(2 * squares_s2 / (n - 1) / n),
                    step_s / std::sqrt(12.0));
}

// The distance of the answer from that of the direct method, and the uncertainty of that one. The scatter of
// the pairs does not contain errors that all pairs share, such as those of lines of both directions at the
// same angles.
Certainty of_stationary(const OffsetSearch& search, const SharedByCandidates& shared, double offset_s,
                        double step_s, const Job& job) {
  const std::optional<double> of_pairs_s = sigma_of_pairs(search, shared, offset_s, step_s);
  const StationaryDirect direct = solve_stationary(search.grid, offset_s, {}, job);
  const auto of_direct_s = sigma_of(direct, *search.problem.recording);
  if (!of_pairs_s || !of_direct_s || direct.matches < StationaryDirectOptions().min_matches)
    return {of_pairs_s, {}, 0};
  return {std::max(*of_pairs_s, std::hypot(direct.offset_s - offset_s, *of_direct_s)),
          trend_of_blocks(direct.block_s, direct.block_offset_s, direct.block_sigma_s), *of_direct_s};
}

// How far the answer lies from that of the joint least squares, and how far that one may be off.
Certainty of_walk(const SolvedWalk& walk, double offset_s) {
  if (!walk.joint) return {};
  return {std::hypot(walk.joint->offset_s - offset_s, walk.joint->sigma_s), drift_of(*walk.joint),
          walk.joint->sigma_s};
}

// A slow motor leaves d so flat that the least of many candidates is chance.
Fit fit_of(const OffsetSearch& search) {
  const bool slow = search.scale.unit_s > 1e-3;
  return search.options.fit.value_or(search.as_moving() || slow ? Fit::kParabola : Fit::kNone);
}

// The criteria's extrema, the one that gives the answer first, and what they say against an answer.
void add_extrema(Answer& answer, const OffsetSearch& search, std::size_t best) {
  const auto& curve = answer.curve;
  const bool moving = search.as_moving();
  // Of 386 recordings of sweepscope_calibration: beyond a unit d and e are no hyperbola any more, while the
  // top of n is so flat that three units err less than one.
  constexpr double kReach_units = 1, kReachOfMatches_units = 3;
  const double fitted_s = fit_of(search) == Fit::kParabola ? search.scale.unit_s : 0.0;
  const auto optimum_of = [&](const char* name, CurveValue value, std::size_t at) {
    const double units = value == &CurvePoint::n ? kReachOfMatches_units : kReach_units;
    return answer.criteria.emplace_back(named(name, fitted_extremum(curve, value, at, units * fitted_s)));
  };
  const CriterionOptimum min = optimum_of(moving ? "e" : "d", decisive(search), best);
  if (moving) {
    const CriterionOptimum max = optimum_of("n", &CurvePoint::n, index_of_max(curve, &CurvePoint::n));
    compare_criteria(answer, max.offset_s, min.offset_s, search.scale);
    const std::size_t cheapest = index_of_min(curve, &CurvePoint::capped_cost_m);
    if (cheapest < curve.size()) optimum_of("capped_cost", &CurvePoint::capped_cost_m, cheapest);
  }
  if (curve.size() > 2 && (best == 0 || best + 1 == curve.size()))
    answer.refusals.push_back(
        refusal(kEdgeOfSearch, min.offset_s * 1e3, moving ? "of e" : "of d", min.offset_s * 1e3));
}

}  // namespace

Answer judged_by_criteria(const OffsetSearch& search, const SharedByCandidates& shared, Answer answer,
                          const Job& job) {
  const bool moving = search.as_moving();
  const Recording& recording = *search.problem.recording;
  const MotorMotion& motor = search.problem.motor;
  const std::size_t best = index_of_min(answer.curve, decisive(search));
  if (best == answer.curve.size()) {
    answer.refusals.push_back(moving ? lost_refusal(*shared.walk, recording)
                                     : refusal(kSweepsNotRegistered, {}));
    return answer;
  }
  add_extrema(answer, search, best);
  if (moving && shared.walk->joint)
    add(answer.refusals, lever_refusal(shared.walk->joint->lever_m, shared.walk->joint->reach_m));
  if (!moving)
    add(answer.refusals, rotation_refusal(answer.curve, answer.curve[best].offset_s, search.scale.unit_s,
                                          motor.median_speed_rad_s));
  if (!moving) add(answer.refusals, apart_refusal(answer.curve[best]));
  if (!answer.refusals.empty()) return answer;
  const double offset_s = answer.criteria.front().offset_s;
  const double step_s =
      fit_of(search) == Fit::kParabola ? 0 : step_about(answer.curve, offset_s, search.scale.unit_s);
  const Certainty certainty =
      moving ? of_walk(*shared.walk, offset_s) : of_stationary(search, shared, offset_s, step_s, job);
  if (certainty.drift) {
    answer.drift_ppm = certainty.drift->slope * 1e6;
    OffsetEvidence evidence;
    evidence.duration_s = search.recorded_s();
    evidence.min_window_s = double(kMinSweepsOfWindow) * motor.median_sweep_s;
    add(answer.refusals, drift_refusal(*certainty.drift, search.recorded_s(), certainty.drift_sigma_s,
                                       advice_on_change(evidence, std::nullopt)));
  }
  if (!answer.refusals.empty()) return answer;
  answer.offset_s = offset_s;
  if (certainty.sigma_s)
    answer.sigma_s = std::hypot(*certainty.sigma_s, unseen_sigma_s(recording, motor, offset_s));
  if (moving && search.recorded_s() < 20)
    answer.warnings.push_back(
        "Less than 20 s of walking: the answer may be off by several tenths of a millisecond.");
  return answer;
}

}  // namespace sweepscope
