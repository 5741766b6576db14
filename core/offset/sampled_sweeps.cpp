#include "core/offset/sampled_sweeps.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace sweepscope
