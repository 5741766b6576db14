#include "core/offset/estimator.hpp"

#include <chrono>
#include <ctime>

#include "core/offset/find_offset.hpp"
#include "core/offset/over_time.hpp"
#include "core/offset/rig_estimate.hpp"

namespace sweepscope {
namespace {

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

Result<Estimate> estimate_by(const Recording& sample, const Sampled& sampled, const EstimateOptions& options,
                             const KeptCandidates& kept, const Job& job) {
  const auto prepared = prepare(sample, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  auto result = find_offset(*prepared, options, kept, job, &sampled);
  if (!result || sampled.sweeps == nullptr) return result;
  if (!options.over_time_s) result->sample = sampled.sweeps->counts;
  if (!result->over_time) return result;
  result->sweeps = sampled.sweeps->counts.of_sweeps;
  result->scans = 0;
  for (const OffsetWindow& window : result->over_time->windows) result->scans += window.scans;
  return result;
}

// The sweeps that an estimate uses; absent if it uses all of the recording at once.
std::optional<SampledSweeps> deciding_sweeps(const Recording& recording, const EstimateOptions& options) {
  if (method_of(options, kUnknownKind) != Method::kDirect) return std::nullopt;
  const bool may_stand = options.assume != RigKind::kMoving && !options.poses;
  return may_stand || options.over_time_s ? sampled_sweeps(recording) : std::nullopt;
}

// The answer over time, or that of a long stationary recording from a sample of its sweeps. Absent if all of
// the recording has to be used at once.
std::optional<Result<Estimate>> estimate_in_parts(const Recording& recording, const EstimateOptions& options,
                                                  const KeptCandidates& kept, const Job& job,
                                                  bool parts_only = false) {
  if (kept.store != nullptr || kept.shard || recording.scans.empty()) return std::nullopt;
  const auto sweeps = deciding_sweeps(recording, options);
  const bool over_time = options.over_time_s && method_of(options, kUnknownKind) == Method::kDirect;
  if (!sweeps && !over_time) return std::nullopt;
  if (!sweeps) return estimate_by(recording, {recording, nullptr}, options, kept, job);
  auto result =
      estimate_by(parts_of(recording, sweeps->groups), {recording, &*sweeps, parts_only}, options, kept, job);
  const bool moved = result && result->kind == RigKind::kMoving;
  if (moved && (parts_only || !over_time) && !job.cancelled()) return std::nullopt;
  return result;
}

// CPU and wall time since its construction.
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

// No answer is given once the job is cancelled, wherever it was interrupted.
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
