#include "core/together/estimate_together.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/rig_estimate.hpp"
#include "core/rig_solve/rig_agreement.hpp"
#include "core/together/common_offset.hpp"

namespace sweepscope {
namespace {

// One of the recordings.
struct Member {
  PreparedRecording prepared;
  Estimate found;               // the offset alone, then with the rig of all
  std::optional<RigPart> part;  // from which the rig is solved for
};

Result<void> check_options(std::size_t recordings, const EstimateOptions& options) {
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  if (recordings < 2) return refuse("One rig is estimated together from at least two recordings.");
  if (method_of(options, RigKind::kStationary, false) != Method::kDirect)
    return refuse("Several recordings are estimated together by the direct method only.");
  if (options.over_time_s) return refuse("An offset over time belongs to a single recording.");
  if (options.poses) return refuse("Poses belong to a single recording.");
  return {};
}

Result<Member> member_of(const RecordingSource& source, const EstimateOptions& options, const Job& job) {
  EstimateOptions alone = options;
  alone.solve = {};
  Member member;
  if (!options.solve.any())
    return estimate(source, alone, job).map([&](Estimate&& found) {
      member.found = std::move(found);
      return std::move(member);
    });
  const auto whole = source.read({}, job);
  if (!whole) return tl::unexpected(whole.error());
  auto prepared = source.prepare(*whole, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  member.prepared = std::move(*prepared);
  auto found = estimate(member.prepared, alone, job);
  if (!found) return tl::unexpected(found.error());
  member.found = found->offset_is_gauge() ? with_kind_of_gauge(member.prepared, options, std::move(*found))
                                          : std::move(*found);
  if (!job.cancelled()) member.part = part_for_rig(member.prepared, member.found, options, job);
  return member;
}

Result<std::vector<Member>> members_of(const std::vector<RecordingSource>& recordings,
                                       const EstimateOptions& options, const Job& job) {
  std::vector<Member> members;
  for (std::size_t i = 0; i < recordings.size() && !job.cancelled(); ++i) {
    job.report("estimating", double(i) / double(recordings.size()));
    auto member = member_of(recordings[i], options, Job::part_of(job));
    if (!member) return tl::unexpected(member.error());
    members.push_back(std::move(*member));
  }
  return members;
}

bool same_rig(const Rig& a, const Rig& b) {
  return a.mount.axis == b.mount.axis && a.mount.laser_in_motor_xyz_m == b.mount.laser_in_motor_xyz_m &&
         a.mount.laser_in_motor_rpy_deg == b.mount.laser_in_motor_rpy_deg &&
         a.gear.play_deg == b.gear.play_deg && a.gear.encoder_amplitude_deg == b.gear.encoder_amplitude_deg &&
         a.gear.encoder_phase_deg == b.gear.encoder_phase_deg;
}

// A rig has one mount and one gear.
Result<void> check_rigs(const std::vector<Member>& members) {
  const Rig& first = members.front().prepared.recording->rig;
  for (const Member& member : members) {
    const Rig& rig = member.prepared.recording->rig;
    if (same_rig(rig, first)) continue;
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{} and {} have different mounts: give one rig file for all (--rig).",
                               members.front().found.recording, member.found.recording));
  }
  return {};
}

// The members from which the rig is solved for. With an offset each, one that determines none has no place.
std::vector<std::size_t> members_of_rig(const std::vector<Member>& members, bool own_offsets) {
  std::vector<std::size_t> those;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (members[i].part && !(own_offsets && members[i].found.offset_is_gauge())) those.push_back(i);
  return those;
}

struct RigOfAll {
  std::vector<std::size_t> members;
  std::vector<OffsetProblem> problems;  // of these
  SolvedRig solved;
  RigAgreement agreement;
};

RigOfAll rig_of_all(const std::vector<Member>& members, const RigSolve& asked, bool own_offsets,
                    const Job& job) {
  RigOfAll rig;
  rig.members = members_of_rig(members, own_offsets);
  if (rig.members.empty()) return rig;
  RigUnknowns first;
  RigSolve what = asked;
  what.offset = false;
  std::vector<double> offsets_s;
  for (const std::size_t i : rig.members) {
    rig.problems.push_back(members[i].part->problem());
    if (members[i].found.offset_is_gauge()) continue;
    what.offset = true;
    offsets_s.push_back(members[i].part->offset_s);
  }
  if (own_offsets)
    first.apart_s = offsets_s;
  else
    first.offset_s = median(offsets_s);
  job.report("solving for the rig", 0.5);
  rig.solved = solve_rig(rig.problems, first, what, job);
  if (!job.cancelled()) rig.agreement = agreement_of(rig.problems, rig.solved, job);
  return rig;
}

// Finds the offsets again with the rig of all.
Result<void> find_with_rig(std::vector<Member>& members, const SolvedRig& solved,
                           const EstimateOptions& options, const Job& job) {
  EstimateOptions alone = options;
  alone.solve = {};
  for (Member& member : members) {
    if (member.found.offset_is_gauge() || job.cancelled()) continue;
    auto found = estimate(with_rig(*member.prepared.recording, solved), alone, job);
    if (!found) return tl::unexpected(found.error());
    member.found = std::move(*found);
  }
  return {};
}

double worst_sigma(const RigMatrix& covariance, RigUnknown first) {
  const Eigen::Matrix2d of_these = covariance.block<2, 2>(first, first);
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(of_these).eigenvalues()[1]));
}

RecordingOfRig evidence_of(const Member& member, double share) {
  RecordingOfRig evidence;
  evidence.recording = member.found.recording;
  if (member.found.identifiable) {
    evidence.offset_s = member.found.offset_s;
    evidence.sigma_s = member.found.sigma_s;
  }
  evidence.share = share;
  evidence.reasons = member.found.reasons();
  return evidence;
}

void add_rig_evidence(const RigOfAll& rig, const std::vector<Member>& members, const RigSolve& asked,
                      Together& together) {
  std::vector<char> solved(together.recordings.size(), 0);
  for (std::size_t k = 0; k < rig.agreement.recordings.size(); ++k) {
    const RigEvidence& evidence = rig.agreement.recordings[k];
    RecordingOfRig& recording = together.recordings[rig.members[k]];
    solved[rig.members[k]] = 1;
    recording.residual_before_m = evidence.residual_before_m;
    recording.residual_after_m = evidence.residual_after_m;
    if (!asked.mount || !evidence.converged) continue;
    recording.turn_sigma_rad = worst_sigma(evidence.covariance, kTurnU);
    recording.shift_sigma_m = worst_sigma(evidence.covariance, kShiftU);
  }
  for (std::size_t i = 0; i < solved.size(); ++i)
    if (!solved[i] && members[i].found.kind == RigKind::kMoving)
      together.recordings[i].reasons.push_back(
          "The rig was not solved for from it: it has no part of 6 s in which it was stationary.");
}

// How far a recording lies from the others, as a sentence's part.
std::string differences(const RigUnknowns& apart, const RigSolve& asked, bool own_offsets) {
  std::vector<std::string> parts;
  if (asked.mount)
    parts.push_back(fmt::format("{:.2f} deg and {:.0f} mm of the mount", apart.turn_rad.norm() * kDegPerRad,
                                apart.shift_m.norm() * 1e3));
  if (asked.play) parts.push_back(fmt::format("{:.2f} deg of play", apart.play_rad * kDegPerRad));
  if (asked.encoder)
    parts.push_back(fmt::format("{:.2f} deg of the encoder", apart.encoder_rad.norm() * kDegPerRad));
  if (!own_offsets) parts.push_back(fmt::format("{:.3f} ms of the offset", std::abs(apart.offset_s) * 1e3));
  return fmt::format("{}", fmt::join(parts, ", "));
}

// Refuses recordings that do not agree on one rig.
void judge(const RigOfAll& rig, const OffsetAgreement& offsets, const EstimateOptions& options,
           Estimate& result) {
  Together& together = *result.together;
  const bool by_rig = !rig.agreement.recordings.empty();
  if (!by_rig && together.own_offsets) return;  // nothing in common
  together.chi_square = by_rig ? rig.agreement.chi_square : offsets.chi_square;
  together.degrees_of_freedom = by_rig ? rig.agreement.degrees_of_freedom : offsets.degrees_of_freedom;
  if (together.degrees_of_freedom == 0) return;
  const double sigmas = (together.chi_square - together.degrees_of_freedom) /
                        std::sqrt(2.0 * together.degrees_of_freedom);  // as chi-square is distributed
  if (sigmas <= kLimits.max_chi_square_sigmas) return;
  std::string who = "it cannot be determined which one differs";
  if (const auto odd = by_rig ? rig.agreement.odd_one : offsets.odd_one) {
    const std::size_t member = by_rig ? rig.members[*odd] : *odd;
    who = fmt::format(
        "{} differs from the others by {}", together.recordings[member].recording,
        by_rig ? differences(rig.agreement.recordings[*odd].apart, options.solve, together.own_offsets)
               : fmt::format("{:.3f} ms", std::abs(offsets.odd_apart_s) * 1e3));
  }
  result.refusals.push_back(refusal(
      RefusalKind::kRecordingsDiffer, sigmas, together.chi_square, together.degrees_of_freedom, who,
      together.own_offsets ? ""
                           : ". If the offset changed between them, solve for one of each (--offsets each)"));
}

// All but the answer.
Estimate begun(const std::vector<Member>& members, bool own_offsets) {
  Estimate result;
  std::vector<std::string> names;
  result.together = Together{};
  result.together->own_offsets = own_offsets;
  for (const Member& member : members) {
    names.push_back(member.found.recording);
    result.sweeps += member.found.sweeps;
    result.scans += member.found.scans;
    result.interrupted |= member.found.interrupted;
    for (const std::string& warning : member.found.warnings)
      result.warnings.push_back(member.found.recording + ": " + warning);
  }
  result.recording = fmt::format("{}", fmt::join(names, ", "));
  return result;
}

// The offset in common; where there is none, why.
void set_offset(const std::vector<Member>& members, const CommonOffset& common, Estimate& result) {
  if (!common.offset_s || result.together->own_offsets) {
    for (const Member& member : members)
      for (Refusal refusal : member.found.refusals) {
        refusal.text = member.found.recording + ": " + refusal.text;
        result.refusals.push_back(std::move(refusal));
      }
    return;
  }
  result.offset_s = common.offset_s;
  result.sigma_s = common.sigma_s;
  result.sigma_parts = common.sigma_parts;
}

// The rig of all, whose uncertainty every offset contains.
void add_rig(const RigOfAll& rig, Estimate& result) {
  const SolvedRig& solved = rig.solved;
  if (result.sigma_s) {
    result.sigma_s = std::hypot(*result.sigma_s, solved.offset_sigma_s);
    result.sigma_parts.push_back({"rig", solved.offset_sigma_s});
  }
  for (const RigFinding& part : {solved.mount, solved.play, solved.encoder})
    if (!part.reason.empty()) result.warnings.push_back(part.reason);
  // With an offset each, one that the rig was not solved for from follows it as the worst of the others.
  const std::vector<double>& own_s = solved.own_offset_sigma_s;
  std::vector<double> sigma_s(result.together->recordings.size(),
                              own_s.empty() ? solved.offset_sigma_s : std::ranges::max(own_s));
  for (std::size_t k = 0; k < own_s.size(); ++k) sigma_s[rig.members[k]] = own_s[k];
  for (std::size_t i = 0; i < sigma_s.size(); ++i)
    if (auto& offset_sigma_s = result.together->recordings[i].sigma_s)
      offset_sigma_s = std::hypot(*offset_sigma_s, sigma_s[i]);
  result.rig = std::make_shared<const SolvedRig>(solved);
}

}  // namespace

Result<Estimate> estimate_together(const std::vector<RecordingSource>& recordings,
                                   const EstimateOptions& options, bool own_offsets, const Job& job) {
  if (const auto checked = check_options(recordings.size(), options); !checked)
    return tl::unexpected(checked.error());
  auto members = members_of(recordings, options, job);
  if (!members) return tl::unexpected(members.error());
  RigOfAll rig;
  if (options.solve.any() && !job.cancelled()) {
    if (const auto checked = check_rigs(*members); !checked) return tl::unexpected(checked.error());
    rig = rig_of_all(*members, options.solve, own_offsets, job);
    if (!rig.members.empty())
      if (const auto found = find_with_rig(*members, rig.solved, options, job); !found)
        return tl::unexpected(found.error());
  }
  Estimate result = begun(*members, own_offsets);
  result.interrupted |= job.cancelled();
  if (result.interrupted) return result;
  std::vector<const Estimate*> found;
  for (const Member& member : *members) found.push_back(&member.found);
  const CommonOffset common = common_offset(found);
  for (std::size_t i = 0; i < members->size(); ++i)
    result.together->recordings.push_back(evidence_of((*members)[i], common.shares[i]));
  set_offset(*members, common, result);
  if (!rig.members.empty()) {
    add_rig(rig, result);
    add_rig_evidence(rig, *members, options.solve, *result.together);
  }
  judge(rig, common.agreement, options, result);
  result.identifiable = result.refusals.empty() && (result.offset_s || own_offsets);
  if (!result.identifiable) result.offset_s.reset();
  return result;
}

}  // namespace sweepscope
