#include "core/offset/rig_estimate.hpp"

#include <cmath>
#include <memory>

#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {
namespace {

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

// On a walk, a wrong mount looks like a body that sways with the motor, and the trajectory absorbs it.
Estimate refused_as_moving(const Estimate& found) {
  Estimate result;
  result.recording = found.recording;
  result.method = found.method;
  result.kind = found.kind;
  result.kind_reason = found.kind_reason;
  result.sweeps = found.sweeps;
  result.scans = found.scans;
  result.warnings = found.warnings;
  result.reasons = {
      "The rig moved, and its parts are solved for from a stationary recording only: record 8 s without motion, "
      "or choose such a part with --window."};
  return result;
}

}  // namespace

Result<Estimate> estimate_with_rig(const PreparedRecording& prepared, const EstimateOptions& options,
                                   const KeptCandidates& kept, const Job& job) {
  if (method_of(options, RigKind::kStationary, kept.store != nullptr) != Method::kDirect)
    return failure(ExitCode::kWrongUsage, "--solve is used by the direct method only.");
  EstimateOptions offset_only = options;
  offset_only.solve = {};
  auto found = estimate(prepared, offset_only, kept, job);
  if (!found || job.cancelled() || !found->kind) return found;
  if (found->kind == RigKind::kMoving) return refused_as_moving(std::move(*found));
  const auto offset_s = offset_seen_s(*found);
  if (!offset_s) return found;
  auto solved = std::make_shared<SolvedRig>(
      solve_rig(problem_for(prepared, *offset_s, *offset_s), *offset_s, options.solve, job));
  if (job.cancelled()) return found;
  const Recording corrected = with_rig(*prepared.recording, *solved);
  const auto again = prepare(corrected, options.features, job);
  if (!again) return found;
  return estimate(*again, offset_only, kept, job).map([&](Estimate&& answer) {
    return with(std::move(answer), std::move(solved));
  });
}

}  // namespace sweepscope
