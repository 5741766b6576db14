#include "core/offset/rig_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/numbers.hpp"
#include "core/offset/kind/rig_kind.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/walk/walk.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {
namespace {

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

// The rig of a stationary recording, from flat surfaces; null if there is no offset.
std::shared_ptr<const SolvedRig> rig_of_surfaces(const PreparedRecording& prepared, const RigSolve& what,
                                                 const Estimate& found, const Job& job) {
  const auto offset_s = offset_seen_s(found);
  if (!offset_s || job.cancelled()) return nullptr;
  return std::make_shared<const SolvedRig>(
      solve_rig(problem_for(prepared, *offset_s, *offset_s), *offset_s, what, job));
}

// The offset with a rig that was solved for.
Result<Estimate> with_rig_found(const PreparedRecording& prepared, std::shared_ptr<const SolvedRig> solved,
                                const OffsetAlone& offset) {
  return offset.of(with_rig(*prepared.recording, *solved)).map([&](Estimate&& answer) {
    return with(std::move(answer), std::move(solved));
  });
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

// The rig from the part of a walk in which it was stationary; null if that does not determine the requested
// mount.
std::shared_ptr<const SolvedRig> rig_of_standing_part(const PreparedRecording& prepared,
                                                      const MotionPart& part, const EstimateOptions& options,
                                                      const Job& job) {
  const Recording stood = window(*prepared.recording, part.begin_s, part.end_s);
  EstimateOptions offset_only = options;
  offset_only.solve = {};
  offset_only.over_time_s.reset();
  const auto of_part = prepare(stood, options.features, job);
  if (!of_part) return nullptr;
  const auto found = estimate(*of_part, offset_only, {}, job);
  if (!found || found->kind != RigKind::kStationary) return nullptr;
  auto solved = rig_of_surfaces(*of_part, options.solve, *found, job);
  return solved && (solved->mount.identifiable || !options.solve.mount) ? solved : nullptr;
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

std::string from_standing_part(const MotionPart& part) {
  return fmt::format(" The rig was solved for from {:.1f} to {:.1f} s, while it was stationary.",
                     part.begin_s, part.end_s);
}

// A motor that turns one way at one speed: the rig at an offset of 0, which is as good as any other.
Result<Estimate> with_rig_at_any_offset(const PreparedRecording& prepared, const EstimateOptions& options,
                                        Estimate found, const Job& job) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  const KindDecision kind = decide_kind(test_motion(stationary_grid(problem), 0), options);
  found.kind = kind.kind;
  found.kind_reason = kind.reason;
  found.scans = std::size_t(std::ranges::count(problem.scan_used, 1));
  found.sweeps = problem.motor.sweeps.size();
  RigSolve what = options.solve;
  what.offset = false;
  const auto solve = [&](const OffsetProblem& stationary) {
    return with(std::move(found), std::make_shared<const SolvedRig>(solve_rig(stationary, 0, what, job)));
  };
  if (kind.kind == RigKind::kStationary) return solve(problem);
  const auto part = standing_part(prepared);
  if (!part) {
    found.warnings.push_back(
        "The rig was not solved for: it moved, and its motor turns one way at one speed. Keep it stationary for "
        "8 s.");
    return found;
  }
  found.kind_reason += from_standing_part(*part);
  const Recording stood = window(*prepared.recording, part->begin_s, part->end_s);
  return prepare(stood, options.features, job).map([&](const PreparedRecording& of_part) {
    return solve(problem_for(of_part, 0, 0));
  });
}

}  // namespace

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
  if (found->kind == RigKind::kStationary) {
    auto solved = rig_of_surfaces(prepared, options.solve, *found, job);
    return solved && !job.cancelled() ? with_rig_found(prepared, std::move(solved), offset) : found;
  }
  const auto part = standing_part(prepared);
  auto solved = part ? rig_of_standing_part(prepared, *part, options, job) : nullptr;
  if (job.cancelled()) return found;
  if (solved)
    return with_rig_found(prepared, std::move(solved), offset).map([&](Estimate&& answer) {
      answer.kind_reason += from_standing_part(*part);
      return std::move(answer);
    });
  return with_turn_of_walk(prepared, options, std::move(*found), offset);
}

bool has_answer(const Estimate& found) {
  return found.identifiable || (found.offset_is_gauge() && found.rig &&
                                (found.rig->mount.identifiable || found.rig->encoder.identifiable));
}

}  // namespace sweepscope
