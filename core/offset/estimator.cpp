#include "core/offset/estimator.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>

#include "core/offset/find_offset.hpp"
#include "core/offset/rig_estimate.hpp"
#include "core/offset/search/stationary_part.hpp"

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
  result.refusals = {refusal(RefusalKind::kInterrupted, {})};
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

// Whether a part of the recording may answer where the whole does not.
bool parts_may_answer(const Estimate& whole, const EstimateOptions& options) {
  return !whole.identifiable && !whole.interrupted && whole.kind == RigKind::kMoving && !options.assume &&
         !options.poses && !options.over_time_s && options.method != Method::kMoving;
}

// A part of a recording that may be a part itself, in the whole; milliseconds, so that it can be typed.
RecordingPart in_whole(const Recording& recording, const RecordingPart& part) {
  const auto in_ms = [&](double time_s) { return std::floor((recording.begins_s + time_s) * 1e3) / 1e3; };
  return {in_ms(part.begin_s), in_ms(part.end_s)};
}

// The answer of the part in which the rig was stationary, or that of the whole where there is none.
Result<Estimate> of_stationary_part(const RecordingSource& source, Estimate whole,
                                    const EstimateOptions& options, const KeptCandidates& kept,
                                    const Job& job) {
  const auto recording = source.read({}, job);
  if (!recording) return tl::unexpected(recording.error());
  const auto prepared = source.prepare(*recording, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  const auto part = motion_course(*prepared, job).stationary;
  if (!part || job.cancelled()) return whole;
  const Recording stationary = window(**recording, part->begin_s, part->end_s);
  auto found = find_offset(stationary, plan_estimate(stationary, options, false), options, kept, job);
  if (!found || !found->identifiable || found->kind != RigKind::kStationary) return whole;
  found->stationary_part = in_whole(**recording, *part);
  found->warnings.insert(
      found->warnings.begin(),
      fmt::format("The rig moved, and the whole recording does not determine the offset: only the part from "
                  "{:.1f} to {:.1f} s, in which the rig was stationary, is used.",
                  found->stationary_part->begin_s, found->stationary_part->end_s));
  return found;
}

Estimate interrupted_before(const Recording& recording, const EstimateOptions& options,
                            const KeptCandidates& kept) {
  Estimate none;
  none.recording = recording.name;
  none.method = method_of(options, kUnknownKind, kept.store != nullptr);
  return interrupted(std::move(none));
}

}  // namespace

Result<Estimate> estimate(const RecordingSource& source, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job) {
  const Stopwatch stopwatch;
  const bool keeps = kept.store != nullptr || kept.shard;
  auto found = options.solve.any()
                   ? estimate_with_rig(source, options, kept, job)
                   : find_offset(source, plan_estimate(source.outline(), options, keeps), options, kept, job);
  if (!found && found.error().code == ExitCode::kInterrupted)
    return stopwatch.stopped(interrupted_before(source.outline(), options, kept));
  if (found && !keeps && !options.solve.any() && parts_may_answer(*found, options))
    found = of_stationary_part(source, std::move(*found), options, kept, job);
  if (!found) return found;
  // No answer is given once the job is cancelled, wherever it was interrupted.
  return stopwatch.stopped(job.cancelled() ? interrupted(std::move(*found)) : std::move(*found));
}

Result<Estimate> estimate(const RecordingSource& source, const EstimateOptions& options, const Job& job) {
  return estimate(source, options, {}, job);
}

}  // namespace sweepscope
