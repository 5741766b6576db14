#include "core/offset/estimator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>

#include "core/offset/criteria_search.hpp"
#include "core/offset/direct.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/rig_kind.hpp"
#include "core/offset/still_motion.hpp"
#include "core/rig_solve/rig_solve.hpp"

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
  if (options.solve.any() && !direct) return refuse("--solve is used by the direct method only.");
  if (options.poses && !direct) return refuse("Poses are used by the direct method only.");
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
  append(result.warnings, answer.warnings);
  append(result.reasons, answer.reasons);
  result.identifiable = result.reasons.empty() && answer.offset_s;
  if (!result.identifiable) return result;
  result.offset_s = answer.offset_s;
  result.sigma_s = answer.sigma_s;
  result.sigma_parts = std::move(answer.sigma_parts);
  return result;
}

// From a recording to its offset. Unfinished where the job is cancelled.
Result<Estimate> find_offset(const PreparedRecording& prepared, const EstimateOptions& options,
                             const KeptCandidates& kept, const Job& job) {
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
  const MotionTest motion = test_motion(grid, coarse.offset_or(window->middle_s()));
  const KindDecision kind = decide_kind(motion, options);
  const Method method = method_of(options, kind.kind, kept.store != nullptr);
  const OffsetSearch search{problem, grid, options, scale, *window, coarse, motion, kind.kind, method};
  result = judged(std::move(result), search, kind);
  if (!result.reasons.empty()) return result;
  if (const auto poses = check_poses(search, kind.reason); !poses) return tl::unexpected(poses.error());

  auto answer =
      method == Method::kDirect ? answer_directly(search, job) : answer_by_criteria(search, kept, job);
  if (!answer && answer.error().code == ExitCode::kInterrupted) return result;
  if (!answer) return tl::unexpected(answer.error());
  return with(std::move(result), std::move(*answer));
}

// The answer of the recording as the solved rig has it, which is as uncertain besides as the rig leaves it.
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

// Where an estimate of a stationary rig takes the offset to be, or, where the rig is too wrong for one, where
// the candidates' cost is least.
std::optional<double> offset_seen_s(const Estimate& found) {
  if (!found.criteria.empty()) return found.criteria.front().offset_s;
  const CurvePoint* best = nullptr;
  for (const CurvePoint& point : found.curve)
    if (point.capped_cost_m && (best == nullptr || *point.capped_cost_m < *best->capped_cost_m))
      best = &point;
  return best == nullptr ? std::nullopt : std::optional(best->offset_s);
}

// The rig is solved for first; the recording as it then is gives the offset.
Result<Estimate> find_with_rig(const PreparedRecording& prepared, const EstimateOptions& options,
                               const KeptCandidates& kept, const Job& job) {
  auto found = find_offset(prepared, options, kept, job);
  if (!found || job.cancelled() || !found->kind) return found;
  // A mount that is wrong sways the points with the motor as a body that sways does: a walk, which may sway,
  // takes its place.
  if (found->kind == RigKind::kMoving)
    return refused(
        without_answer(std::move(*found)),
        {"The rig moved, and its parts are solved for from a stationary recording only: record 8 s "
         "without motion, or choose such a part with --window."});
  const auto offset_s = offset_seen_s(*found);
  if (!offset_s) return found;
  auto solved = std::make_shared<SolvedRig>(
      solve_rig(problem_for(prepared, *offset_s, *offset_s), *offset_s, options.solve, job));
  if (job.cancelled()) return found;
  const Recording corrected = with_rig(*prepared.recording, *solved);
  const auto again = prepare(corrected, options.features, job);
  if (!again) return found;
  return find_offset(*again, options, kept, job).map([&](Estimate&& answer) {
    return with(std::move(answer), std::move(solved));
  });
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

}  // namespace

Result<Estimate> estimate(const PreparedRecording& prepared, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job) {
  const Stopwatch stopwatch;
  auto result = options.solve.any() ? find_with_rig(prepared, options, kept, job)
                                    : find_offset(prepared, options, kept, job);
  if (!result) return result;
  // Whatever was cut short, wherever: no answer is given once the job is cancelled.
  return stopwatch.stopped(job.cancelled() ? interrupted(std::move(*result)) : std::move(*result));
}

Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job) {
  const Stopwatch stopwatch;
  const auto prepared = prepare(recording, options.features, job);
  if (!prepared) {
    Estimate none;
    none.recording = recording.name;
    none.method = method_of(options, kUnknownKind, kept.store != nullptr);
    return stopwatch.stopped(interrupted(std::move(none)));
  }
  return estimate(*prepared, options, kept, job).map([&](Estimate&& result) {
    return stopwatch.stopped(std::move(result));
  });
}

Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, const Job& job) {
  return estimate(recording, options, {}, job);
}

}  // namespace sweepscope
