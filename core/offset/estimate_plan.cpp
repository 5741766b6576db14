#include "core/offset/estimate_plan.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/over_time/over_time.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

std::optional<SampledSweeps> sampled_sweeps(const Recording& recording) {
  constexpr double kLong_s = 60;                           // shorter ones take seconds as a whole
  constexpr double kMargin_s = 0.1, kMarginOfSweep = 0.2;  // for offsets of a search, beyond the sweeps
  // Sixty sweeps as of a recording of half a minute, whose sigma more sweeps would not reduce; ten groups
  // show a drift, and six sweeps are the fewest of which each direction has three.
  constexpr std::size_t kGroups = 10, kSweeps = 6;
  if (recording.scans.empty()) return std::nullopt;
  const double begin_s = recording.scans.front().first_beam_s, end_s = recording.scans.back().first_beam_s;
  if (end_s - begin_s < kLong_s) return std::nullopt;
  const MotorMotion motor = find_sweeps(recording.motor);
  std::vector<Sweep> sweeps;  // scanned completely
  for (const Sweep& sweep : motor.sweeps)
    if (sweep.begin_s >= begin_s && sweep.end_s <= end_s) sweeps.push_back(sweep);
  if (sweeps.size() < 2 * kGroups * kSweeps) return std::nullopt;
  const double margin_s = kMargin_s + kMarginOfSweep * motor.median_sweep_s;
  SampledSweeps sampled{{}, {kGroups, kGroups * kSweeps, sweeps.size()}};
  for (std::size_t group = 0; group < kGroups; ++group) {
    const std::size_t first = group * (sweeps.size() - kSweeps) / (kGroups - 1);
    sampled.groups.push_back(
        {sweeps[first].begin_s - begin_s - margin_s, sweeps[first + kSweeps - 1].end_s - begin_s + margin_s});
  }
  return sampled;
}

std::shared_ptr<const Recording> EstimatePlan::sweeps_of(std::shared_ptr<const Recording> recording) const {
  return sample ? std::make_shared<const Recording>(parts_of(*recording, sample->groups)) : recording;
}

EstimatePlan plan_estimate(const Recording& outline, const EstimateOptions& options, bool keeps_candidates) {
  EstimatePlan plan;
  if (outline.scans.empty() || method_of(options, kUnknownKind, keeps_candidates) != Method::kDirect)
    return plan;
  const MotorMotion motor = find_sweeps(outline.motor);
  if (options.over_time_s) plan.windows = windows_over_time(outline, motor, options.over_time_s);
  const bool may_be_stationary = options.assume != RigKind::kMoving && !options.poses;
  if (may_be_stationary || plan.over_time()) plan.sample = sampled_sweeps(outline);
  if (!plan.sample) return plan;
  plan.parts = plan.sample->groups;
  for (const RecordingPart& part : used_parts(plan.windows, motor)) plan.parts.push_back(part);
  return plan;
}

}  // namespace sweepscope
