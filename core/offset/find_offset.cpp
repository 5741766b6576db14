#include "core/offset/find_offset.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/offset/criteria_search.hpp"
#include "core/offset/direct.hpp"
#include "core/offset/direct_stationary.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/over_time.hpp"
#include "core/offset/rig_kind.hpp"
#include "core/offset/still_motion.hpp"

namespace sweepscope {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

Estimate refused(Estimate result, const std::vector<std::string>& reasons) {
  append(result.reasons, reasons);
  return result;
}

// Why the motor's track or the stamps cannot be used, whatever the scans show.
std::vector<std::string> stream_reasons(const PreparedRecording& prepared, const SearchScale& scale) {
  const Recording& recording = *prepared.recording;
  std::vector<std::string> reasons = motor_reasons(recording.motor, prepared.motor);
  if (!reasons.empty()) return reasons;
  if (const auto stamps = stamps_reason(recording, scale)) reasons.push_back(*stamps);
  if (const auto sparse = sampling_reason(recording.motor, prepared.motor, scale)) reasons.push_back(*sparse);
  return reasons;
}

Estimate begun(const PreparedRecording& prepared, const EstimateOptions& options, const KeptCandidates& kept,
               const SearchScale& scale) {
  Estimate result;
  result.recording = prepared.recording->name;
  result.warnings = prepared.recording->report.warnings;
  result.method = method_of(options, kUnknownKind, kept.store != nullptr);
  result.reasons = stream_reasons(prepared, scale);
  if (!result.reasons.empty()) return result;
  if (const auto few = sampling_warning(prepared.recording->motor, prepared.motor))
    result.warnings.push_back(*few);
  return result;
}

Result<SearchWindow> window_of(const EstimateOptions& options, const SearchScale& scale) {
  std::vector<OffsetRange> ranges = options.ranges;
  if (options.around) ranges.push_back(range_around(*options.around));
  const bool by_default = ranges.empty();
  if (by_default) ranges.push_back({-scale.half_width_s, scale.half_width_s, scale.unit_s});
  return checked_offsets(ranges, scale).map([&](std::vector<double>&& offsets_s) {
    return SearchWindow{std::move(offsets_s), by_default};
  });
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
  if (auto gaps = gaps_reason(*problem.recording, problem.scan_used, window.from_s(), window.to_s()))
    return refused(std::move(result), {*gaps});
  result.scans = scans;
  if (result.sweeps < 2)
    return refused(std::move(result),
                   {"Fewer than two sweeps have both scans and motor samples at every offset searched."});
  if (auto few = lines_reason(distinct_lines(*problem.recording, problem.motor, window.middle_s())))
    return refused(std::move(result), {*few});
  return result;
}

// The kind of rig and the method, and the reasons why the recording cannot be used with them.
Estimate judged(Estimate result, const OffsetSearch& search, const KindDecision& kind) {
  result.kind = search.kind;
  result.kind_reason = kind.reason;
  result.method = search.method;
  append(result.warnings, kind.warnings);
  append(result.reasons, one_way_reasons(search.problem.motor, search.kind, search.method));
  if (search.method == Method::kStationary && search.kind == RigKind::kMoving)
    result.reasons.push_back(moved_text(search.motion) +
                             " Use the method for moving rigs (--method moving), or, if the rig was "
                             "stationary, say so (--assume stationary).");
  const bool seen_moving = search.motion.moving() && !search.options.assume;
  const std::size_t min_sweeps = std::size_t(search.options.mapping.settling_sweeps) + 12;
  if (search.as_moving() && result.sweeps < min_sweeps)
    result.reasons.push_back(
        fmt::format("{}The recording is too short for a moving rig: {} sweeps, at least {} are needed, and "
                    "40 s of walking for a good result.",
                    seen_moving ? moved_text(search.motion) + " " : "", result.sweeps, min_sweeps));
  return result;
}

Estimate with(Estimate result, Answer answer) {
  result.curve = std::move(answer.curve);
  result.criteria = std::move(answer.criteria);
  result.lost = std::move(answer.lost);
  result.motion = std::move(answer.motion);
  result.fit = answer.fit;
  result.rig_effects = answer.rig_effects;
  result.walk = std::move(answer.walk);
  result.drift_ppm = answer.drift_ppm;
  result.over_time = std::move(answer.over_time);
  append(result.warnings, answer.warnings);
  append(result.reasons, answer.reasons);
  result.identifiable = result.reasons.empty() && answer.offset_s;
  if (!result.identifiable) return result;
  result.offset_s = answer.offset_s;
  result.sigma_s = answer.sigma_s;
  result.sigma_parts = std::move(answer.sigma_parts);
  return result;
}

EstimatePart estimator_of_parts(const EstimateOptions& options, const Job& job) {
  return [&options, &job](const Recording& part) -> Result<Estimate> {
    const auto prepared = prepare(part, options.features, job);
    if (!prepared) return tl::unexpected(prepared.error());
    return find_offset(*prepared, options, {}, job);
  };
}

// The offset over time, or a constant one if the groups of a sample of sweeps agree.
Result<Answer> answer_sampled(const OffsetSearch& search, const Sampled& sampled,
                              const OffsetOverTime& groups, const Job& job) {
  if (search.options.over_time_s)
    return answer_over_time(search, sampled.whole, estimator_of_parts(search.options, job), job);
  const auto changes = change_reason(groups, search.recorded_s());
  if (!changes) return answer_directly(search, job);
  Answer answer;
  answer.curve = search.coarse.curve;
  answer.reasons.push_back(*changes);
  return answer;
}

// The offset of each group of the sample; empty for a whole recording, and without a coarse offset.
OffsetOverTime groups_of(const Sampled* sampled, const PreparedRecording& prepared,
                         const CoarseSearch& coarse, const EstimateOptions& options, const Job& job) {
  if (sampled == nullptr || sampled->sweeps == nullptr || !coarse.best) return {};
  if (options.assume == RigKind::kMoving) return {};
  return follow_groups(*prepared.recording, sampled->sweeps->groups, coarse.offset_s(), options.features,
                       job);
}

// The motion test of a short recording, with pairs of neighbouring sweeps.
MotionTest test_motion_of_few(const StillGrid& grid, const CoarseSearch& coarse, MotionTest test,
                              const Job& job) {
  if (!coarse.best || !has_few_pairs(test)) return test;
  StationaryDirectOptions options;
  options.resampling = Resampling::kNone;
  add_neighbours(grid, solve_stationary(grid, coarse.offset_s(), options, job).offset_s, test);
  return test;
}

// The motion test. It compares sweeps far apart in time, so a changing offset is removed first.
MotionTest test_motion(const PreparedRecording& prepared, const StillGrid& grid, const OffsetOverTime& groups,
                       double offset_s) {
  const auto& course = groups.course;
  if (!course || course->constant() || 2 * course->windows < groups.windows.size())
    return test_motion(grid, offset_s);
  Recording corrected = *prepared.recording;
  corrected.motor = without_course(corrected, *course);
  PreparedRecording as_if = prepared;
  as_if.recording = &corrected;
  as_if.motor = find_sweeps(corrected.motor);
  return test_motion(as_if);
}

}  // namespace

Result<Estimate> find_offset(const PreparedRecording& prepared, const EstimateOptions& options,
                             const KeptCandidates& kept, const Job& job, const Sampled* sampled) {
  const SearchScale scale = search_scale(prepared.motor);
  Estimate result = begun(prepared, options, kept, scale);
  if (!result.reasons.empty()) return result;
  const auto window = check_options(options, kept).and_then([&] { return window_of(options, scale); });
  if (!window) return tl::unexpected(window.error());
  const OffsetProblem problem = problem_for(prepared, window->from_s(), window->to_s());
  result = counted(std::move(result), problem, *window);
  if (!result.reasons.empty()) return result;

  const StillGrid grid = still_grid(problem);
  const CoarseSearch coarse =
      search_coarsely(problem, window->from_s(), window->to_s(), scale, job, kept.finished);
  if (job.cancelled()) return result;
  const OffsetOverTime groups = groups_of(sampled, prepared, coarse, options, job);
  if (job.cancelled()) return result;
  const MotionTest motion = test_motion_of_few(
      grid, coarse, test_motion(prepared, grid, groups, coarse.offset_or(window->middle_s())), job);
  if (job.cancelled()) return result;
  const KindDecision kind = decide_kind(motion, options);
  const Method method = method_of(options, kind.kind, kept.store != nullptr);
  const OffsetSearch search{problem, grid, options, scale, *window, coarse, motion, kind.kind, method};
  const bool needs_whole = sampled != nullptr && (sampled->parts_only || !options.over_time_s);
  if (needs_whole && search.as_moving()) {
    result.kind = kind.kind;
    return result;
  }
  result = judged(std::move(result), search, kind);
  if (!result.reasons.empty()) return result;
  if (const auto poses = check_poses(search, kind.reason); !poses) return tl::unexpected(poses.error());

  auto answer = sampled != nullptr          ? answer_sampled(search, *sampled, groups, job)
                : method == Method::kDirect ? answer_directly(search, job)
                                            : answer_by_criteria(search, kept, job);
  if (!answer && answer.error().code == ExitCode::kInterrupted) return result;
  if (!answer) return tl::unexpected(answer.error());
  return with(std::move(result), std::move(*answer));
}

}  // namespace sweepscope
