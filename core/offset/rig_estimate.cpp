#include "core/offset/rig_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/numbers.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/kind/rig_kind.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/walk/walk.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {
namespace {

// The offset of an estimate of a stationary rig, or, if the rig file is too wrong for one, the candidate with
// the lowest cost.
std::optional<double> offset_seen_s(const Estimate& found) {
  if (!found.criteria.empty()) return found.criteria.front().offset_s;
  const CurvePoint* best = nullptr;
  for (const CurvePoint& point : found.curve)
    if (point.capped_cost_m && (best == nullptr || *point.capped_cost_m < *best->capped_cost_m))
      best = &point;
  return best == nullptr ? std::nullopt : std::optional(best->offset_s);
}

// The longest part of a walk in which the rig was stationary, if it is long enough to solve for a rig.
std::optional<MotionPart> standing_part(const PreparedRecording& prepared) {
  constexpr double kMin_s = 6, kMinSweeps = 10;  // 8 s are advised
  constexpr double kPairs = 64;                  // that are compared at most: the last may already be moving
  const std::vector<MotionPart> parts = motion_over_time(prepared);
  std::optional<MotionPart> longest;
  const auto length_s = [](const MotionPart& part) { return part.end_s - part.begin_s; };
  for (const MotionPart& part : parts)
    if (!part.moved && (!longest || length_s(part) > length_s(*longest))) longest = part;
  if (!longest) return longest;
  if (longest->end_s < parts.back().end_s) longest->end_s -= parts.back().end_s / kPairs;
  const MotorMotion& motor = prepared.motor;
  if (length_s(*longest) < std::max(kMin_s, kMinSweeps * motor.median_sweep_s)) longest.reset();
  return longest;
}

std::string from_standing_part(const MotionPart& part) {
  return fmt::format(" The rig was solved for from {:.1f} to {:.1f} s, while it was stationary.",
                     part.begin_s, part.end_s);
}

// The offset of a part; none where the rig moved in it after all.
std::optional<double> offset_of_part_s(const PreparedRecording& part, const EstimateOptions& options,
                                       const Job& job) {
  EstimateOptions offset_only = options;
  offset_only.solve = {};
  offset_only.over_time_s.reset();
  const auto found = estimate(part, offset_only, {}, job);
  return found && found->kind == RigKind::kStationary ? offset_seen_s(*found) : std::nullopt;
}

// Estimates the offset alone.
struct OffsetAlone {
  EstimateOptions options;
  const KeptCandidates& kept;
  const Job& job;

  Result<Estimate> of(const RecordingSource& recording) const {
    return estimate(recording, options, kept, job);
  }
};

// The answer with the solved rig; its sigma contains that of the rig.
Estimate with(Estimate found, std::shared_ptr<const SolvedRig> solved) {
  if (found.sigma_s) {
    found.sigma_s = std::hypot(*found.sigma_s, solved->offset_sigma_s);
    found.sigma_parts.push_back({"rig", solved->offset_sigma_s});
  }
  for (const RigFinding& part : {solved->mount, solved->play, solved->encoder})
    if (!part.reason.empty()) found.warnings.push_back(part.reason);
  found.rig = std::move(solved);
  return found;
}

std::shared_ptr<const SolvedRig> rig_of_part(const RigPart& part, const RigSolve& what, const Job& job) {
  const OffsetProblem problem = part.problem();
  return std::make_shared<const SolvedRig>(solve_rig({&problem, 1}, {.offset_s = part.offset_s}, what, job));
}

// The offset with a rig that was solved for.
Result<Estimate> with_rig_found(const PreparedRecording& prepared, std::shared_ptr<const SolvedRig> solved,
                                const OffsetAlone& offset) {
  return offset.of(with_rig(*prepared.recording, *solved)).map([&](Estimate&& answer) {
    return with(std::move(answer), std::move(solved));
  });
}

std::optional<WalkTurn> turn_seen(const Recording& recording, const Estimate& found) {
  if (!found.walk || !found.walk->joint) return std::nullopt;
  return turn_of_walk(recording, found.walk->joint->sweeps, found.walk->joint->offset_s);
}

// The part of a turn that is not known: 1 where it may as well be none.
double unsure_of_turn(const SolvedRig& solved) {
  const double sigma_rad = std::sqrt(solved.covariance.block<2, 2>(kTurnU, kTurnU).trace());
  const double turn_rad = solved.found.turn_rad.norm();
  return sigma_rad < turn_rad ? sigma_rad / turn_rad : 1;
}

// The offset at which a walk was solved, also where it is refused; 0 where it was not solved.
double offset_along(const Estimate& found) {
  return found.walk && found.walk->joint ? found.walk->joint->offset_s : 0;
}

// A walk: the turn that its path shows, and the walk again with it, until the turn converges. Nothing else of
// the rig is determined.
Result<Estimate> with_turn_of_walk(const PreparedRecording& prepared, const EstimateOptions& options,
                                   Estimate found, const OffsetAlone& offset) {
  constexpr int kMaxPasses = 5;     // a bound
  constexpr double kSettled = 0.3;  // of sigma
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  SolvedRig solved = rig_of_walk(problem, {}, options.solve);
  const double residual_before_m = found.fit ? found.fit->residual_m : 0;
  const double first_offset_s = offset_along(found);
  std::vector<double> steps_rad;
  Recording turned;
  for (int pass = 0; options.solve.mount && pass < kMaxPasses && !solved.converged; ++pass) {
    const auto seen = turn_seen(pass == 0 ? *prepared.recording : turned, found);
    if (!seen && pass == 0) {
      found.warnings.push_back(
          "The rig was not solved for: this requires 10 s of motion in a walk that the direct method "
          "solved.");
      return found;
    }
    if (!seen) break;
    const Eigen::Vector2d before_rad = solved.found.turn_rad;
    solved = rig_of_walk(problem, {before_rad + seen->turn_rad, seen->covariance}, options.solve);
    steps_rad.push_back((solved.found.turn_rad - before_rad).norm());
    solved.covariance.diagonal().segment<2>(kTurnU).array() += std::pow(unconverged_rad(steps_rad), 2);
    solved.iterations = pass + 1;
    solved.converged = steps_rad.back() < kSettled * std::sqrt(seen->covariance.diagonal().minCoeff());
    turned = with_rig(*prepared.recording, solved);
    auto again = offset.of(turned);
    if (!again || again->interrupted) return again;
    found = std::move(*again);
  }
  constexpr double kScatters_rad = 0.3 * kRadPerDeg;  // 26 of 28 benchmark walks leave less
  if (const double open_rad = unconverged_rad(steps_rad); open_rad > kScatters_rad)
    found.warnings.push_back(fmt::format(
        "Successive solutions of the walk turn the mount by {:.1f} deg against each other: the motion was "
        "not followed well. Walk and turn more slowly, or keep the rig stationary for 8 s.",
        open_rad * kDegPerRad));
  solved.residual_before_m = residual_before_m;
  solved.residual_after_m = found.fit ? found.fit->residual_m : 0;
  solved.points = found.fit ? found.fit->matches : 0;
  solved.offset_sigma_s = std::hypot(solved.offset_sigma_s,
                                     unsure_of_turn(solved) * std::abs(offset_along(found) - first_offset_s));
  return with(std::move(found), std::make_shared<const SolvedRig>(std::move(solved)));
}

// Why there is no stationary part in which a rig could be solved for.
std::string why_no_part(const PreparedRecording& prepared) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  if (has_few_lines(*problem.recording, problem.motor))
    return fmt::format(
        "The rig was not solved for: the scan lines are {:.0f} deg of the motor's angle apart, too far to see "
        "whether it was stationary. Turn the motor more slowly.",
        problem.line_spacing_rad * kDegPerRad);
  return "The rig was not solved for: its sweeps do not match, as those of a rig that moved, and its motor "
         "turns one way at one speed. Keep it stationary for 8 s; if it was, state it (estimate --assume "
         "stationary).";
}

// A motor that turns one way at one speed: the rig at an offset of 0, which is as good as any other.
Estimate with_rig_at_any_offset(const PreparedRecording& prepared, const EstimateOptions& options,
                                Estimate found, const Job& job) {
  found = with_kind_of_gauge(prepared, options, std::move(found));
  const auto part = part_for_rig(prepared, found, options, job);
  if (!part) {
    found.warnings.push_back(why_no_part(prepared));
    return found;
  }
  found.kind_reason += part->note;
  RigSolve what = options.solve;
  what.offset = false;
  return with(std::move(found), rig_of_part(*part, what, job));
}

}  // namespace

std::optional<RigPart> part_for_rig(const PreparedRecording& prepared, const Estimate& found,
                                    const EstimateOptions& options, const Job& job) {
  const bool gauge = found.offset_is_gauge();
  if (found.kind == RigKind::kStationary) {
    const auto offset_s = gauge ? std::optional(0.0) : offset_seen_s(found);
    return offset_s ? std::optional(RigPart{prepared, *offset_s, ""}) : std::nullopt;
  }
  const auto standing = standing_part(prepared);
  if (!standing) return std::nullopt;
  auto of_part = prepare(
      std::make_shared<const Recording>(window(*prepared.recording, standing->begin_s, standing->end_s)),
      options.features, job);
  if (!of_part) return std::nullopt;
  const auto offset_s = gauge ? std::optional(0.0) : offset_of_part_s(*of_part, options, job);
  if (!offset_s) return std::nullopt;
  return RigPart{std::move(*of_part), *offset_s, from_standing_part(*standing)};
}

Estimate with_kind_of_gauge(const PreparedRecording& prepared, const EstimateOptions& options,
                            Estimate found) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  const KindDecision kind = decide_kind(test_motion(stationary_grid(problem), 0), options);
  found.kind = kind.kind;
  found.kind_reason = kind.reason;
  found.scans = std::size_t(std::ranges::count(problem.scan_used, 1));
  found.sweeps = problem.motor.sweeps.size();
  return found;
}

Result<Estimate> estimate_with_rig(const RecordingSource& source, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job) {
  if (method_of(options, RigKind::kStationary, kept.store != nullptr) != Method::kDirect)
    return failure(ExitCode::kWrongUsage, "Parts of the rig are solved for by the direct method only.");
  OffsetAlone offset{options, kept, job};
  offset.options.solve = {};
  const auto whole = source.read({}, job);
  if (!whole) return tl::unexpected(whole.error());
  const auto with_features = source.prepare(*whole, options.features, job);
  if (!with_features) return tl::unexpected(with_features.error());
  const PreparedRecording& prepared = *with_features;
  auto found = offset.of(prepared);
  if (!found || job.cancelled()) return found;
  if (found->offset_is_gauge()) return with_rig_at_any_offset(prepared, options, std::move(*found), job);
  if (!found->kind) return found;
  const bool moved = found->kind == RigKind::kMoving;
  const auto part = part_for_rig(prepared, *found, options, job);
  auto solved = part && !job.cancelled() ? rig_of_part(*part, options.solve, job) : nullptr;
  if (job.cancelled()) return found;
  // A walk shows the turn of a mount that its stationary part does not determine.
  if (moved && (!solved || (options.solve.mount && !solved->mount.identifiable)))
    return with_turn_of_walk(prepared, options, std::move(*found), offset);
  if (!solved) return found;
  return with_rig_found(prepared, std::move(solved), offset).map([&](Estimate&& answer) {
    answer.kind_reason += part->note;
    return std::move(answer);
  });
}

bool has_answer(const Estimate& found) {
  return found.identifiable || (found.offset_is_gauge() && found.rig &&
                                (found.rig->mount.identifiable || found.rig->encoder.identifiable));
}

}  // namespace sweepscope
