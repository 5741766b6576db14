#include "core/offset/find_offset.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/offset/criteria/criteria_search.hpp"
#include "core/offset/direct/direct.hpp"
#include "core/offset/estimate_over_time.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/judgement/warnings.hpp"
#include "core/offset/kind/rig_kind.hpp"
#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/over_time/over_time.hpp"
#include "core/offset/stationary/direct_stationary.hpp"

namespace sweepscope {
namespace {

using enum RefusalKind;

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

// Why the motor's track or the stamps cannot be used, whatever the scans show.
Refusals stream_refusals(const PreparedRecording& prepared, const SearchScale& scale) {
  const Recording& recording = *prepared.recording;
  Refusals refusals;
  add(refusals, motor_faults_refusal(recording.report));
  if (!refusals.empty()) return refusals;
  add(refusals, motor_refusal(recording.motor, prepared.motor));
  if (!refusals.empty()) return refusals;
  add(refusals, scan_times_refusal(recording, scale));
  add(refusals, samples_refusal(recording.motor, prepared.motor, scale));
  return refusals;
}

Estimate begun(const PreparedRecording& prepared, const EstimatePlan& plan, const EstimateOptions& options,
               const KeptCandidates& kept, const SearchScale& scale) {
  Estimate result;
  if (plan.sample && !plan.over_time()) result.sample = plan.sample->counts;
  result.recording = prepared.recording->name;
  result.warnings = prepared.recording->report.warnings;
  result.readings = prepared.recording->report.readings;
  result.method = method_of(options, kUnknownKind, kept.store != nullptr);
  result.refusals = stream_refusals(prepared, scale);
  if (result.refusals.empty())
    add(result.warnings, sampling_warning(prepared.recording->motor, prepared.motor));
  return result;
}

Result<SearchWindow> window_of(const EstimateOptions& options, const SearchScale& scale) {
  std::vector<OffsetRange> ranges = options.ranges;
  if (options.around) ranges.push_back(range_around(*options.around));
  const bool by_default = ranges.empty();
  if (const auto& search = options.search; by_default && search)
    ranges.push_back({search->from_s, search->to_s, scale.unit_s});
  else if (by_default)
    ranges.push_back({-scale.half_width_s, scale.half_width_s, scale.unit_s});
  return checked_offsets(ranges, scale).map([&](std::vector<double>&& offsets_s) {
    return SearchWindow{std::move(offsets_s), by_default};
  });
}

// The coarse search, in a window that it may move.
CoarseSearch searched(const PreparedRecording& prepared, const EstimateOptions& options,
                      const SearchScale& scale, const KeptCandidates& kept, SearchWindow& window,
                      const Job& job) {
  if (!window.by_default || options.search) {
    const double from_s = window.from_s(), to_s = window.to_s();
    return search_coarsely(problem_for(prepared, from_s, to_s), from_s, to_s, scale, job, kept.watch);
  }
  SearchedWindow found = search_by_default(prepared, scale, job, kept.watch);
  window.offsets_s = offsets_of({{found.from_s, found.to_s, scale.unit_s}});
  return std::move(found.coarse);
}

// Options that contradict each other, whatever the recording.
Result<void> check_options(const EstimateOptions& options, const KeptCandidates& kept) {
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  const bool direct = method_of(options, kUnknownKind, kept.store != nullptr) == Method::kDirect;
  if (direct && kept.store != nullptr)
    return refuse("The direct method takes seconds and has no candidates.");
  if (kept.shard && options.ranges.empty() && !options.around)
    return refuse("A shard needs --range or --around: the default search chooses its candidates as it goes.");
  if (options.poses && !direct) return refuse("Poses are used by the direct method only.");
  if (options.over_time_s && !direct)
    return refuse("The offset over time is found by the direct method only.");
  return {};
}

Result<void> check_poses(const OffsetSearch& search, const std::string& kind_reason) {
  const auto& poses = search.options.poses;
  if (!poses) return {};
  if (poses->poses.size() < 2)
    return failure(ExitCode::kUnreadableInput,
                   fmt::format("{}: a trajectory needs at least two poses", poses->file));
  if (search.kind == RigKind::kMoving) return {};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: poses are not used for a stationary rig: leave out {}. {}",
                             search.problem.recording->name, poses->file, kind_reason));
}

// Counts the usable scans and sweeps, and refuses if there are too few.
Estimate counted(Estimate result, const OffsetProblem& problem, const SearchWindow& window) {
  SweepPlacer placer(problem, window.middle_s());
  std::size_t scans = 0;
  for (PlacedSweep sweep; placer.next(sweep); ++result.sweeps) scans += sweep.scans;
  add(result.refusals, gaps_refusal(*problem.recording, problem.scan_used, window.from_s(), window.to_s()));
  if (!result.refusals.empty()) return result;
  result.scans = scans;
  if (result.sweeps < kLimits.min_sweeps)
    result.refusals.push_back(refusal(kFewSweeps, double(result.sweeps)));
  else
    add(result.refusals, lines_refusal(distinct_lines(*problem.recording, problem.motor, window.middle_s())));
  return result;
}

// That the rig moved, as a sentence before another; about a wrong axis a stationary rig seems to move.
std::string moved_before(const OffsetSearch& search) {
  if (!search.motion.moving() || search.options.assume) return "";
  const Recording& recording = *search.problem.recording;
  if (has_few_lines(recording, search.problem.motor))
    return fmt::format(
        "{} Or the scan lines of a sweep, {:.0f} deg of the motor's angle apart, are too few to compare: if the rig was "
        "stationary, turn the motor more slowly, less far or in smaller steps, or state it (estimate --assume "
        "stationary). ",
        moved_text(search.motion), search.problem.line_spacing_rad * kDegPerRad);
  const bool stated = recording.rig.states_mount();
  return moved_text(search.motion) +
         (stated
              ? " "
              : " If it was stationary, its motor may turn the laser about another axis than x: set mount: "
                "{axis: ...} in a rig file. ");
}

// The kind of rig and the method, and why the recording cannot be used with them.
Estimate judged(Estimate result, const OffsetSearch& search, const KindDecision& kind) {
  result.kind = search.kind;
  result.kind_reason = kind.reason;
  result.method = search.method;
  append(result.warnings, kind.warnings);
  add(result.refusals, one_way_refusal(search.problem.motor, search.kind, search.method));
  if (search.method == Method::kStationary && search.kind == RigKind::kMoving)
    result.refusals.push_back(refusal(kRigMoved, {}, moved_text(search.motion)));
  const std::size_t min_sweeps =
      std::size_t(search.options.mapping.settling_sweeps) + kLimits.min_walk_sweeps;
  if (search.as_moving() && result.sweeps < min_sweeps)
    result.refusals.push_back(
        refusal(kShortWalk, double(result.sweeps), moved_before(search), result.sweeps, min_sweeps));
  return result;
}

// What was said before is kept; all else is the answer's.
Estimate with(Estimate result, Answer answer) {
  append(result.warnings, answer.warnings);
  answer.warnings = std::move(result.warnings);
  static_cast<Answer&>(result) = std::move(answer);
  result.identifiable = result.refusals.empty() && result.offset_s;
  if (result.identifiable) return result;
  result.offset_s.reset();
  result.sigma_s.reset();
  result.sigma_parts.clear();
  return result;
}

// What a refusal may be due to where a motor without an encoder is said to turn at an exact speed.
Estimate with_speed_note(Estimate result, const Recording& recording) {
  const auto& profile = recording.rig.motor.profile;
  if (result.identifiable || !profile || !profile->between || recording.report.profile_speed_sigma_s > 0)
    return result;
  result.warnings.push_back(
      "at a wrong speed of the profile it looks as if the rig moved or the clocks drifted: state "
      "turns_per_s_within in the profile, and the speed is found");
  return result;
}

// The offset of each group of a sample of sweeps; empty for a whole recording, and without a coarse offset.
OffsetOverTime groups_of(const EstimatePlan& plan, const PreparedRecording& prepared,
                         const CoarseSearch& coarse, const EstimateOptions& options, const Job& job) {
  if (!plan.sample || !coarse.best || options.assume == RigKind::kMoving) return {};
  return follow_groups(*prepared.recording, plan.sample->groups, coarse.offset_s(), options.features, job);
}

// The motion test of a short recording, with pairs of neighbouring sweeps and groups of scan lines.
MotionTest test_motion_of_few(const StationaryGrid& grid, const CoarseSearch& coarse, MotionTest test,
                              const Job& job) {
  if (!coarse.best || !has_few_pairs(test)) return test;
  StationaryDirectOptions options;
  options.resampling = Resampling::kNone;
  const double best_s = solve_stationary(grid, coarse.offset_s(), options, job).offset_s;
  add_neighbours(grid, best_s, test);
  if (!test.moving()) test.within_sweeps = moved_within_sweeps(grid, best_s);
  return test;
}

// The motion test. It compares sweeps far apart in time, so a changing offset is removed first.
MotionTest test_motion(const PreparedRecording& prepared, const StationaryGrid& grid,
                       const OffsetOverTime& groups, double offset_s) {
  const auto& course = groups.course;
  if (!course || course->constant() || 2 * course->windows < groups.windows.size())
    return test_motion(grid, offset_s);
  Recording corrected = *prepared.recording;
  corrected.motor = without_course(corrected, *course);
  PreparedRecording as_if = prepared;
  as_if.motor = find_sweeps(corrected);
  as_if.recording = borrowed(corrected);
  return test_motion(as_if);
}

// The answer of the method, or none where the groups of a sample of sweeps do not agree on an offset.
Result<Answer> answer_by_method(const OffsetSearch& search, const OffsetOverTime& groups,
                                const KeptCandidates& kept, const Job& job) {
  if (search.method != Method::kDirect) return answer_by_criteria(search, kept, job);
  auto changes = change_refusal(groups, search.recorded_s(), search.problem.motor.median_sweep_s);
  if (!changes) return answer_directly(search, job);
  Answer answer;
  answer.curve = search.coarse.curve;
  answer.refusals.push_back(std::move(*changes));
  return answer;
}

}  // namespace

Result<Estimate> find_offset(const RecordingSource& source, const EstimatePlan& plan,
                             const EstimateOptions& options, const KeptCandidates& kept, const Job& job) {
  const auto recording = source.read(plan.parts, job);
  if (!recording) return tl::unexpected(recording.error());
  const auto prepared = source.prepare(plan.sweeps_of(*recording), options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  const SearchScale scale = search_scale(prepared->motor);
  Estimate result = begun(*prepared, plan, options, kept, scale);
  if (!result.refusals.empty()) return result;
  auto window = check_options(options, kept).and_then([&] { return window_of(options, scale); });
  if (!window) return tl::unexpected(window.error());
  const CoarseSearch coarse = searched(*prepared, options, scale, kept, *window, job);
  if (job.cancelled()) return result;
  const OffsetProblem problem = problem_for(*prepared, window->from_s(), window->to_s());
  result = counted(std::move(result), problem, *window);
  if (!result.refusals.empty()) return result;

  const StationaryGrid grid = stationary_grid(problem);
  const OffsetOverTime groups = groups_of(plan, *prepared, coarse, options, job);
  if (job.cancelled()) return result;
  const MotionTest motion = test_motion_of_few(
      grid, coarse, test_motion(*prepared, grid, groups, coarse.offset_or(window->middle_s())), job);
  if (job.cancelled()) return result;
  const KindDecision kind = decide_kind(motion, options);
  const Method method = method_of(options, kind.kind, kept.store != nullptr);
  const OffsetSearch search{problem, grid, options, scale, *window, coarse, motion, kind.kind, method};
  if (plan.sample && !plan.over_time() && search.as_moving())
    return find_offset(source, {}, options, kept, job);  // a walk takes all of its sweeps
  result = judged(std::move(result), search, kind);
  if (!result.refusals.empty()) return with_speed_note(std::move(result), **recording);
  if (const auto poses = check_poses(search, kind.reason); !poses) return tl::unexpected(poses.error());

  if (plan.over_time()) return follow_over_time(std::move(result), search, source, **recording, plan, job);
  auto answer = answer_by_method(search, groups, kept, job);
  if (!answer && answer.error().code == ExitCode::kInterrupted) return result;
  if (!answer) return tl::unexpected(answer.error());
  return with_speed_note(with(std::move(result), std::move(*answer)), **recording);
}

}  // namespace sweepscope
