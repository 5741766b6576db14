#include "core/offset/direct/direct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/direct/direct_moving.hpp"
#include "core/offset/judgement/evidence.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/judgement/warnings.hpp"
#include "core/offset/readings/beam_readings.hpp"

#include "core/offset/stationary/direct_stationary.hpp"
#include "core/offset/walk/motion_source.hpp"
#include "core/rig_solve/rig_check.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

using enum RefusalKind;

constexpr double kMinPart_s = 5;  // of a walk over time: shorter parts hold too few turns

// Takes over what the evidence says, and sigma as it leaves it.
std::optional<double> judged_by(Verdict verdict, Answer& answer) {
  for (const auto& [name, by_s] : verdict.widened) answer.sigma_parts.push_back({name, by_s});
  answer.warnings.insert(answer.warnings.end(), verdict.warnings.begin(), verdict.warnings.end());
  for (Refusal& refused : verdict.refusals) answer.refusals.push_back(std::move(refused));
  return verdict.sigma_s;
}

// The answer with its offset, where nothing speaks against one.
Answer concluded(Answer answer, double offset_s, std::optional<double> sigma_s, double value,
                 const OffsetSearch& search) {
  answer.criteria.push_back({"direct", offset_s, value});
  const auto& window = search.coarse.curve;
  if (offset_s < window.front().offset_s || offset_s > window.back().offset_s)
    answer.refusals.push_back(refusal(kBeyondSearch, offset_s * 1e3, offset_s * 1e3));
  add(answer.refusals, sigma_refusal(sigma_s, search.scale));
  if (!answer.refusals.empty()) return answer;
  answer.offset_s = offset_s;
  answer.sigma_s = sigma_s;
  return answer;
}

// What the motion of a rig that is treated as stationary leaves uncertain. From one sweep to the next it
// moves half as far as to the next but one, and an error of the offset turns the two against each other by
// twice the motor's speed times it; motion one way and the other averages out over the pairs.
double motion_sigma_s(const MotionTest& motion, double lever_m, double speed_rad_s) {
  if (!motion.moving()) return 0;
  return motion.median_apart_m / 2 / (2 * speed_rad_s * lever_m) /
         std::sqrt(double(std::max<std::size_t>(1, motion.pairs)));
}

MaybeRefusal motion_refusal(double sigma_s, const SearchScale& scale) {
  if (sigma_s < kLimits.max_motion_sigma_units * scale.unit_s) return std::nullopt;
  return refusal(kMovedTooFar, sigma_s / scale.unit_s, sigma_s * 1e3);
}

// Gear play h turns the directions against each other as an offset of h / (2 omega) does.
RigEffects rig_effects(const MotorMotion& motor) {
  return {1 / (2 * motor.median_speed_rad_s), std::nullopt};
}

// What the rig could add, and whether surfaces would be flatter with another one.
void judge_rig(Answer& answer, const OffsetSearch& search, double offset_s, const Job& job) {
  const RigCheck check = check_rig(search.problem, offset_s, job);
  answer.rig_effects->mount_tilt_s_rad = check.offset_per_tilt_s_rad;
  add(answer.warnings, check.warning);
}

// A gear whose play differs with the angle, or a loose mount, makes the offset that fits depend on it.
Remark sectors_warning(const StationaryDirect& found) {
  if (!found.depends_on_angle) return std::nullopt;
  constexpr double kMinShare = 0.05;  // of less, a sector's offset is hardly determined
  std::vector<SectorOffset> sectors = found.sectors;
  std::erase_if(sectors, [](const SectorOffset& sector) { return sector.share < kMinShare; });
  const auto [min, max] = std::ranges::minmax_element(sectors, {}, &SectorOffset::offset_s);
  if (min == max) return std::nullopt;
  return fmt::format(
      "The best offset depends on the motor's angle: {:.1f} ms at {:.0f} deg, {:.1f} ms at {:.0f} deg. A "
      "loose gear or mount can cause this.",
      min->offset_s * 1e3, min->angle_rad * kDegPerRad, max->offset_s * 1e3, max->angle_rad * kDegPerRad);
}

// A rig file that states other times of the beams than the surfaces show is not overruled.
Remark reading_warning(const Recording& recording, const StationaryDirect& found) {
  const auto better = better_reading(recording, found);
  if (!better) return std::nullopt;
  return fmt::format(
      "The surfaces fit better if {}: from its first to its last beam a scan takes {:.1f} ms {} than the {} says. "
      "Set laser: {{time_increment_s: {:.6g}}} in a rig file.",
      entry_of(better->kind).description, std::abs(found.scan_time_error_s) * 1e3,
      found.scan_time_error_s > 0 ? "more" : "less",
      recording.rig.laser.time_increment_s ? "rig file" : "recording", better->time_increment_s);
}

// What the fit of a stationary rig shows about its answer. Where the offset may change, its parts are judged
// as windows.
OffsetEvidence evidence_of(const OffsetSearch& search, const StationaryDirect& found) {
  OffsetEvidence evidence;
  evidence.converged = found.converged;
  if (std::abs(found.step_s) >= StationaryDirectOptions().step_tolerance_s)
    evidence.last_step_s = found.step_s;
  evidence.residual_m = found.residual_m;
  evidence.range_noise_m = search.problem.features->range_noise_m;
  evidence.lever_m_s = found.lever_m_s;
  if (search.options.over_time_s) return evidence;
  const double begin_s = search.problem.recording->scans.front().first_beam_s;
  for (std::size_t i = 0; i < found.block_s.size(); ++i)
    evidence.parts.push_back(
        {found.block_s[i] - begin_s, found.block_offset_s[i], found.offset_s, found.block_sigma_s[i]});
  evidence.trend = trend_of_blocks(found.block_s, found.block_offset_s, found.block_sigma_s);
  evidence.duration_s = search.recorded_s();
  evidence.min_window_s = double(kMinSweepsOfWindow) * search.problem.motor.median_sweep_s;
  return evidence;
}

Answer of_stationary(const OffsetSearch& search, Answer answer, const Job& job) {
  const Recording& recording = *search.problem.recording;
  const StationaryDirect found = solve_stationary(search.grid, search.coarse.offset_s(), {}, job);
  if (job.cancelled()) return answer;
  answer.fit = FitEvidence{found.converged,  found.iterations, found.features, found.matches,
                           found.residual_m, found.lever_m,    found.reach_m};
  if (found.matches < StationaryDirectOptions().min_matches) {
    answer.refusals.push_back(refusal(kFewMatches, double(found.matches), found.matches, found.features));
    return answer;
  }
  add(answer.refusals, lever_refusal(found.lever_m, found.reach_m));
  add(answer.warnings, few_matches_warning(found.matches, found.features));
  add(answer.warnings, sectors_warning(found));
  add(answer.warnings, reading_warning(recording, found));
  std::optional<double> sigma_s = sigma_of(found, recording);
  const double stamps_s = stamps_sigma_s(recording),
               encoder_s = unseen_sigma_s(recording, search.problem.motor, found.offset_s);
  if (sigma_s) {
    answer.sigma_parts = {{"statistical", *sigma_s}, {"stamps", stamps_s}, {"encoder", encoder_s}};
    sigma_s = std::hypot(*sigma_s, encoder_s);
  }
  const double of_motion_s =
      motion_sigma_s(search.motion, found.lever_m, search.problem.motor.lever_speed_rad_s());
  if (const auto moved_far = motion_refusal(of_motion_s, search.scale))
    answer.refusals.push_back(*moved_far);
  else if (sigma_s)
    sigma_s = std::hypot(*sigma_s, of_motion_s);
  answer.sigma_parts.push_back({"motion", of_motion_s});
  if (const auto trend = trend_of(found.block_s, found.block_offset_s)) answer.drift_ppm = trend->slope * 1e6;
  sigma_s = judged_by(judge_constant(evidence_of(search, found), sigma_s), answer);
  answer.rig_effects = rig_effects(search.problem.motor);
  judge_rig(answer, search, found.offset_s, job);
  return concluded(std::move(answer), found.offset_s, sigma_s, found.residual_m, search);
}

// The map must be sharpest at the offset that fits the walk best.
MaybeRefusal sharpest_refusal(const std::vector<CurvePoint>& sides) {
  const auto &below = sides.front().e_m, &here = sides[1].e_m, &above = sides.back().e_m;
  if (!here) return refusal(kNoMatchesAtOffset, {});
  if ((!below || *below >= *here) && (!above || *above >= *here)) return std::nullopt;
  return refusal(kMapNotSharpest, {}, *here * 1e3, below.value_or(0) * 1e3, above.value_or(0) * 1e3);
}

// A body that sways in step with the motor looks much like an offset.
Remark sway_warning(double sway_rad) {
  constexpr double kUsual_rad = 0.014;  // of any walk: the sweeps' own scatter
  if (sway_rad < kUsual_rad) return std::nullopt;
  return fmt::format(
      "The trajectory turns back and forth in step with the motor, by {:.1f} deg from sweep to sweep: the "
      "rig swayed in this way, or the sweeps overlap too little. Walk at another pace or turn the motor at "
      "another speed.",
      sway_rad * kDegPerRad);
}

// Why nothing can be said of a walk.
Refusal missing_refusal(const OffsetProblem& problem, const SolvedWalk& walk,
                        const std::optional<MotionSource>& source) {
  if (!walk.lost) return refusal(kFewSharedSurfaces, {}, "");
  if (source && source->motion.is_truth()) return refusal(kPosesCoverFewSweeps, {}, source->name);
  return lost_refusal(walk, *problem.recording);
}

Remark left_out_warning(const std::vector<Interval>& lost, const std::optional<MotionSource>& source) {
  const Remark warning = lost_warning(lost);
  if (!warning || !source || !source->motion.is_truth()) return warning;
  return fmt::format(
      "{} does not cover all scans: {} intervals are left out, the first from {:.1f} to {:.1f} s.",
      source->name, lost.size(), lost.front().begin_s, lost.front().end_s);
}

// What a walk shows about its answer. Where the offset may change, its parts are judged as windows.
OffsetEvidence evidence_of(const OffsetSearch& search, const MovingDirect& solved,
                           const std::optional<Trend>& drift) {
  const JointWalk& walk = *solved.walk->joint;
  OffsetEvidence evidence;
  evidence.converged = solved.converged;
  evidence.last_step_s = solved.converged ? 0 : walk.step_s;
  evidence.steps_may_alternate = true;
  evidence.duration_s = search.recorded_s();
  evidence.min_window_s = JointWalkOptions().part_s;
  if (search.options.over_time_s) return evidence;
  const double begin_s = search.problem.recording->scans.front().first_beam_s;
  evidence.trend = drift;
  for (const JointWalkPart& part : walk.parts)
    evidence.parts.push_back({part.middle_s - begin_s, part.offset_s});
  return evidence;
}

// What the parts' own sigmas leave of their mean. Where the offset may change, the parts' scatter says
// nothing.
double sigma_of_parts(const JointWalk& walk) {
  double information = 0;
  for (const JointWalkPart& part : walk.parts) information += 1 / (part.sigma_s * part.sigma_s);
  return 1 / std::sqrt(information);
}

// Sweeps so long that no walk of theirs could determine the offset: solving for it would cost minutes.
MaybeRefusal hopeless_sweeps_refusal(const OffsetSearch& search, double part_s) {
  const OffsetProblem& problem = search.problem;
  const double parts = std::max(1.0, search.recorded_s() / part_s),
               sweeps = std::max(1.0, part_s / problem.motor.median_sweep_s),
               unseen_s = unseen_of_part_s(*problem.recording, problem.motor, std::size_t(sweeps)) /
                          std::sqrt(parts);
  if (unseen_s < kLimits.max_hopeless_units * search.scale.unit_s) return std::nullopt;
  return long_sweeps_refusal(*problem.recording, problem.motor, unseen_s, unseen_s);
}

// The answer of a walk that was solved, with its uncertainty and what limits it. `given`: along a trajectory
// that is the truth.
Answer judged_walk(const OffsetSearch& search, const MovingDirect& solved, bool given, Answer answer) {
  const OffsetProblem& problem = search.problem;
  const JointWalk& walk = *solved.walk->joint;
  answer.curve = united(std::move(answer.curve), solved.curve);
  const double e_m = solved.curve[1].e_m.value_or(0);
  answer.fit = FitEvidence{solved.converged, 0, walk.features, walk.matches, e_m, walk.lever_m, walk.reach_m};
  add(answer.refusals, lever_refusal(walk.lever_m, walk.reach_m));
  if (!given) add(answer.warnings, sway_warning(solved.sway_rad));
  const bool may_change = search.options.over_time_s.has_value();
  const double encoder_s = unseen_sigma_s(*problem.recording, problem.motor, walk.offset_s),
               sigma_of_walk_s = may_change ? sigma_of_parts(walk) : walk.sigma_s,
               of_walk_s = std::hypot(walk.unseen_sigma_s, walk.sway_sigma_s);
  const std::optional<double> sigma_s = std::hypot(sigma_of_walk_s, encoder_s);
  const bool is_known = !sigma_refusal(sigma_s, search.scale);
  // What warns of the uncertainty of an answer is the reason where it is too large for one.
  answer.limit_by(long_sweeps_refusal(*problem.recording, problem.motor, walk.unseen_sigma_s, walk.sigma_s),
                  !is_known);
  answer.limit_by(smooth_motor_refusal(walk.sway_sigma_s, walk.sigma_s), !is_known);
  answer.sigma_parts = {
      {"statistical", std::sqrt(std::max(0.0, sigma_of_walk_s * sigma_of_walk_s - of_walk_s * of_walk_s))},
      {"path", walk.unseen_sigma_s},
      {"sway", walk.sway_sigma_s},
      {"encoder", encoder_s}};
  answer.rig_effects = rig_effects(problem.motor);
  // Parts without information scatter as if the clocks drifted apart, and their mean is not where the map
  // is sharpest.
  if (is_known) add(answer.refusals, sharpest_refusal(solved.curve));
  const auto drift = is_known ? drift_of(walk) : std::nullopt;
  if (drift) answer.drift_ppm = drift->slope * 1e6;
  const std::optional<double> judged_s =
      judged_by(judge_constant(evidence_of(search, solved, drift), sigma_s), answer);
  add(answer.warnings, few_matches_warning(walk.matches, walk.features));
  return concluded(std::move(answer), walk.offset_s, judged_s, e_m, search);
}

// Of a rig whose trajectory goes by `source`, as far as it is in `mapping`.
Answer of_walk(const OffsetSearch& search, const MappingOptions& mapping,
               const std::optional<MotionSource>& source, Answer answer, const Job& job) {
  const OffsetProblem& problem = search.problem;
  const SearchScale& scale = search.scale;
  WalkOptions walk_by = walk_options(mapping, scale);
  if (search.options.over_time_s && *search.options.over_time_s > 0)
    walk_by.joint.part_s = std::max(kMinPart_s, *search.options.over_time_s);
  if (!source || !source->motion.is_truth())
    add(answer.refusals, hopeless_sweeps_refusal(search, walk_by.joint.part_s));
  if (!answer.refusals.empty()) return answer;
  const auto solved = solve_moving(problem, search.coarse.offset_s(),
                                   {walk_by, kLimits.sharpest_side_units * scale.unit_s}, job);
  if (!solved) return answer;
  answer.walk = solved->walk;
  answer.lost = lost_times(answer.walk->sweeps, *problem.recording);
  if (answer.walk->lost || !answer.walk->joint) {
    answer.refusals.push_back(missing_refusal(problem, *answer.walk, source));
    return answer;
  }
  add(answer.warnings, left_out_warning(answer.lost, source));
  const JointWalk& walk = *answer.walk->joint;
  if (source && walk.time_shift)
    answer.motion = source->used(walk.time_shift);
  else if (source && mapping.given)
    answer.warnings.push_back(fmt::format(
        "{} is not used: the rig's deviation from it is less smooth than its motion.", source->name));
  return judged_walk(search, *solved, source && source->motion.is_truth(), std::move(answer));
}

Result<Answer> of_moving(const OffsetSearch& search, Answer answer, const Job& job) {
  const auto source = motion_source(*search.problem.recording, search.options.poses);
  MappingOptions mapping = mapping_of(search.options);
  if (source) {
    auto aligned = align_motion(search.problem, search.coarse.offset_s(), mapping, *source, job);
    if (!aligned) return tl::unexpected(aligned.error());
    mapping.given = aligned->motion;
    for (std::string& warning : aligned->warnings) answer.warnings.push_back(std::move(warning));
    answer.motion = source->used(aligned->shift);
  }
  return of_walk(search, mapping, source, std::move(answer), job);
}

// Scans may hold nothing; those that cover parts of a turn and could not be put together have no direction in
// common with the next.
std::string why_none_are_shared(const Recording& recording) {
  constexpr double kHardlyAny = 0.01;  // of the beams
  const auto usable = std::ranges::count_if(
      recording.ranges_m, [](float range_m) { return std::isfinite(range_m) && range_m > 0; });
  if (double(usable) < kHardlyAny * double(recording.ranges_m.size()))
    return fmt::format(": of {} beams {} returned a range. Check the scanner, and that nothing covers it",
                       recording.ranges_m.size(), usable);
  std::size_t apart = 0;
  for (std::size_t i = 0; i + 1 < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    const double between_rad = recording.scans[i + 1].angle_min_rad - scan.angle_min_rad,
                 span_rad = std::abs(scan.beams * scan.angle_increment_rad);
    apart += std::abs(std::remainder(between_rad, kFullCircle_rad)) > span_rad / 2 ? 1 : 0;
  }
  if (!recording.directions.empty() || 2 * apart < recording.scans.size()) return " at any candidate offset";
  return ": the messages cover parts of a turn of the mirror, and by the times of their beams they are not put "
         "together. Set laser.time_increment_s in a rig file, or record whole turns";
}

// A search that was limited may have missed the minimum.
MaybeRefusal flat_of(const OffsetSearch& search) {
  MaybeRefusal flat = flat_refusal(search.coarse.curve, *search.coarse.best, search.problem);
  if (flat && search.options.search)
    flat->text += fmt::format(" The search was limited to {:.0f} to {:.0f} ms (--search).",
                              search.window.from_s() * 1e3, search.window.to_s() * 1e3);
  return flat;
}

}  // namespace

Result<Answer> answer_directly(const OffsetSearch& search, const Job& job) {
  const Recording& recording = *search.problem.recording;
  const MotorMotion& motor = search.problem.motor;
  const CoarseSearch& coarse = search.coarse;
  Answer answer;
  answer.curve = coarse.curve;
  if (!coarse.best) {
    add(answer.refusals, unrepeated_lines_refusal(recording));
    answer.refusals.push_back(refusal(kFewSharedSurfaces, {}, why_none_are_shared(recording)));
    return answer;
  }
  add(answer.refusals, beam_times_refusal(recording, search.scale));
  // A walk blurs the valley of the coarse search: only the fit decides whether there is one. So do beams at
  // wrong times.
  if (!search.as_moving() && answer.refusals.empty()) {
    add(answer.refusals, edge_refusal(coarse.curve, *coarse.best));
    const MaybeRefusal flat = flat_of(search);
    if (flat) add(answer.refusals, unrepeated_lines_refusal(recording));
    add(answer.refusals, flat);
    add(answer.refusals, rival_refusal(coarse.curve, *coarse.best, search.scale));
  }
  add(answer.warnings, aliased_warning(recording, motor));
  add(answer.warnings, encoder_warning(recording.motor));
  add(answer.warnings, slow_motor_warning(motor));
  if (!answer.refusals.empty()) return answer;
  return search.as_moving() ? of_moving(search, std::move(answer), job)
                            : of_stationary(search, std::move(answer), job);
}

}  // namespace sweepscope
