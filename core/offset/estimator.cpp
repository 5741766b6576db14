#include "core/offset/estimator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>

#include "core/offset/criteria_search.hpp"
#include "core/offset/direct.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/over_time.hpp"
#include "core/offset/rig_estimate.hpp"
#include "core/offset/rig_kind.hpp"
#include "core/offset/sampled_sweeps.hpp"
#include "core/offset/still_motion.hpp"

namespace sweepscope {
namespace {

constexpr RigKind kUnknownKind = RigKind::kStationary;

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

Estimate refused(Estimate result, std::vector<std::string> reasons) {
  append(result.reasons, reasons);
  return result;
}

Estimate without_answer(Estimate result) {
  result.identifiable = false;
  result.offset_s.reset();
  result.sigma_s.reset();
  result.sigma_parts.clear();
  result.drift_ppm.reset();
  result.criteria.clear();
  return result;
}

Estimate interrupted(Estimate result) {
  result = without_answer(std::move(result));
  result.interrupted = true;
  result.reasons = {"Interrupted; the curve holds the candidates that were finished."};
  return result;
}

// What the motor, the stamps and the motor's samples are good for, whatever the scans show.
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

// What makes no sense together, whatever the recording.
Result<void> check_options(const EstimateOptions& options, const KeptCandidates& kept) {
  const auto refuse = [](const char* why) { return failure(ExitCode::kWrongUsage, why); };
  const bool direct = method_of(options, kUnknownKind, kept.store != nullptr) == Method::kDirect;
  if (direct && kept.store != nullptr)
    return refuse("The direct method takes seconds and has no candidates to keep.");
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
                 fmt::format("{}: poses have no use for a stationary rig: leave out {}. {}",
                             search.problem.recording->name, poses->file, kind_reason));
}

// How many scans and sweeps can be used at all, and whether they suffice.
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

// The kind of rig and the method, and what speaks against treating the sweeps like that.
Estimate judged(Estimate result, const OffsetSearch& search, const KindDecision& kind) {
  result.kind = search.kind;
  result.kind_reason = kind.reason;
  result.method = search.method;
  append(result.warnings, kind.warnings);
  append(result.reasons, one_way_reasons(search.problem.motor, search.kind, search.method));
  if (search.method == Method::kStationary && search.kind == RigKind::kMoving)
    result.reasons.push_back(moved_text(search.motion) +
                             " Use --method moving, or --assume stationary if it was stationary.");
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

struct Sampled;
Result<Estimate> find_offset(const PreparedRecording& prepared, const EstimateOptions& options,
                             const KeptCandidates& kept, const Job& job, const Sampled* sampled = nullptr);

EstimatePart estimator_of_parts(const EstimateOptions& options, const Job& job) {
  return [&options, &job](const Recording& part) -> Result<Estimate> {
    const auto prepared = prepare(part, options.features, job);
    if (!prepared) return tl::unexpected(prepared.error());
    return find_offset(*prepared, options, {}, job);
  };
}

// The recording that a prepared one is a sample of.
struct Sampled {
  const Recording& whole;
  const SampledSweeps* sweeps;  // null: the sample is the whole
  bool parts_only = false;      // `whole` holds only what a stationary rig's answer goes by
};

// The offset over time, or one that the groups of a sample of sweeps agree about.
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

// The offset of the sample's groups; empty of a whole recording, and where there is nothing to start from.
OffsetOverTime groups_of(const Sampled* sampled, const PreparedRecording& prepared,
                         const CoarseSearch& coarse, const EstimateOptions& options, const Job& job) {
  if (sampled == nullptr || sampled->sweeps == nullptr || !coarse.best) return {};
  if (options.assume == RigKind::kMoving) return {};
  return follow_groups(*prepared.recording, sampled->sweeps->groups, coarse.offset_s(), options.features,
                       job);
}

// The motion test, with an offset that changes taken out: sweeps that lie far apart in time could not be
// compared.
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

// From a recording to its offset. Unfinished where the job is cancelled, and where the rig moved and a sample
// does not do.
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
  const CoarseSearch coarse = search_coarsely(problem, window->from_s(), window->to_s(), scale, job);
  if (job.cancelled()) return result;
  const OffsetOverTime groups = groups_of(sampled, prepared, coarse, options, job);
  if (job.cancelled()) return result;
  const MotionTest motion = test_motion(prepared, grid, groups, coarse.offset_or(window->middle_s()));
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

Result<Estimate> estimate_by(const Recording& sample, const Sampled& sampled, const EstimateOptions& options,
                             const Job& job) {
  const auto prepared = prepare(sample, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  auto result = find_offset(*prepared, options, {}, job, &sampled);
  if (!result || sampled.sweeps == nullptr) return result;
  if (!options.over_time_s) result->sample = sampled.sweeps->counts;
  if (!result->over_time) return result;
  result->sweeps = sampled.sweeps->counts.of_sweeps;
  result->scans = 0;
  for (const OffsetWindow& window : result->over_time->windows) result->scans += window.scans;
  return result;
}

// Which sweeps of a recording decide; none where all of it is to be taken at once.
std::optional<SampledSweeps> deciding_sweeps(const Recording& recording, const EstimateOptions& options) {
  if (method_of(options, kUnknownKind) != Method::kDirect) return std::nullopt;
  const bool may_stand = options.assume != RigKind::kMoving && !options.poses;
  return may_stand || options.over_time_s ? sampled_sweeps(recording) : std::nullopt;
}

// The answer over time, or of a long recording of a stationary rig from a sample of its sweeps. None where
// all of the recording is to be taken at once.
std::optional<Result<Estimate>> estimate_in_parts(const Recording& recording, const EstimateOptions& options,
                                                  const KeptCandidates& kept, const Job& job,
                                                  bool parts_only = false) {
  if (kept.store != nullptr || kept.shard || recording.scans.empty()) return std::nullopt;
  const auto sweeps = deciding_sweeps(recording, options);
  const bool over_time = options.over_time_s && method_of(options, kUnknownKind) == Method::kDirect;
  if (!sweeps && !over_time) return std::nullopt;
  if (!sweeps) return estimate_by(recording, {recording, nullptr}, options, job);
  auto result =
      estimate_by(parts_of(recording, sweeps->groups), {recording, &*sweeps, parts_only}, options, job);
  const bool moved = result && result->kind == RigKind::kMoving;
  if (moved && (parts_only || !over_time) && !job.cancelled()) return std::nullopt;
  return result;
}

// Since it was made.
class Stopwatch {
 public:
  Estimate stopped(Estimate result) const {
    result.cpu_s = double(std::clock() - cpu_begin_) / CLOCKS_PER_SEC;
    result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_begin_).count();
    return result;
  }

 private:
  std::clock_t cpu_begin_ = std::clock();
  std::chrono::steady_clock::time_point wall_begin_ = std::chrono::steady_clock::now();
};

Estimate interrupted_before(const Recording& recording, const EstimateOptions& options,
                            const KeptCandidates& kept) {
  Estimate none;
  none.recording = recording.name;
  none.method = method_of(options, kUnknownKind, kept.store != nullptr);
  return interrupted(std::move(none));
}

// Whatever was cut short, wherever: no answer is given once the job is cancelled.
Result<Estimate> concluded(Result<Estimate> result, const Stopwatch& stopwatch, const Job& job) {
  if (!result) return result;
  return stopwatch.stopped(job.cancelled() ? interrupted(std::move(*result)) : std::move(*result));
}

bool was_interrupted(const Result<Estimate>& result) {
  return !result && result.error().code == ExitCode::kInterrupted;
}

}  // namespace

Result<Estimate> estimate(const PreparedRecording& prepared, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job) {
  const Stopwatch stopwatch;
  if (options.solve.any()) return concluded(estimate_with_rig(prepared, options, kept, job), stopwatch, job);
  auto in_parts = estimate_in_parts(*prepared.recording, options, kept, job);
  if (!in_parts) return concluded(find_offset(prepared, options, kept, job), stopwatch, job);
  if (was_interrupted(*in_parts))
    return stopwatch.stopped(interrupted_before(*prepared.recording, options, kept));
  return concluded(std::move(*in_parts), stopwatch, job);
}

Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job) {
  const Stopwatch stopwatch;
  if (options.solve.any()) {
    const auto prepared = prepare(recording, options.features, job);
    if (!prepared) return stopwatch.stopped(interrupted_before(recording, options, kept));
    return estimate(*prepared, options, kept, job);
  }
  if (auto in_parts = estimate_in_parts(recording, options, kept, job)) {
    if (was_interrupted(*in_parts)) return stopwatch.stopped(interrupted_before(recording, options, kept));
    return concluded(std::move(*in_parts), stopwatch, job);
  }
  const auto prepared = prepare(recording, options.features, job);
  if (!prepared) return stopwatch.stopped(interrupted_before(recording, options, kept));
  return concluded(find_offset(*prepared, options, kept, job), stopwatch, job);
}

Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, const Job& job) {
  return estimate(recording, options, {}, job);
}

std::optional<std::vector<RecordingPart>> parts_of_estimate(const Recording& outline,
                                                            const EstimateOptions& options) {
  if (options.solve.any()) return std::nullopt;
  const auto sweeps = deciding_sweeps(outline, options);
  if (!sweeps) return std::nullopt;
  std::vector<RecordingPart> parts = sweeps->groups;
  if (!options.over_time_s) return parts;
  const MotorMotion motor = find_sweeps(outline.motor);
  for (const RecordingPart& part : used_parts(windows_over_time(outline, motor, options), motor))
    parts.push_back(part);
  return parts;
}

Result<std::optional<Estimate>> estimate_by_parts(const Recording& parts, const EstimateOptions& options,
                                                  const Job& job) {
  const Stopwatch stopwatch;
  auto found = estimate_in_parts(parts, options, {}, job, true);
  if (!found) return std::nullopt;
  if (was_interrupted(*found)) return stopwatch.stopped(interrupted_before(parts, options, {}));
  return concluded(std::move(*found), stopwatch, job).map([](Estimate&& result) {
    return std::optional(std::move(result));
  });
}

}  // namespace sweepscope
