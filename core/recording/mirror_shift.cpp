#include "core/recording/mirror_shift.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

// The steady part of a sweep, whose ends are defined alike beside a reversal, a rest and an end of the track.
// A sweep cut off where the recording begins or ends has that end at infinity: anything matches it.
struct Turned {
  double begin_s, end_s;
  bool is_whole() const { return std::isfinite(begin_s) && std::isfinite(end_s); }
};

std::vector<Turned> turned_of(const MotorTrack& track, const MotorMotion& motion) {
  constexpr std::size_t kMaxSweeps = 40;
  const double turning_round_s = motion.median_sweep_s / 2, longest_s = 1.2 * motion.median_sweep_s;
  std::vector<Turned> sweeps;
  for (const Sweep& sweep : motion.sweeps) sweeps.push_back({sweep.steady_begin_s, sweep.steady_end_s});
  // One that is too long holds a rest.
  const auto is_cut = [&](const Turned& sweep, double after_s) {
    return after_s < turning_round_s && sweep.end_s - sweep.begin_s < longest_s;
  };
  const bool first = is_cut(sweeps.front(), sweeps.front().begin_s - track.time_s.front()),
             last = is_cut(sweeps.back(), track.time_s.back() - sweeps.back().end_s);
  if (first) sweeps.front().begin_s = -HUGE_VAL;
  if (last) sweeps.back().end_s = HUGE_VAL;
  sweeps.resize(std::min(sweeps.size(), kMaxSweeps));
  return sweeps;
}

bool turned_at(const std::vector<Turned>& sweeps, double begin_s, double end_s, double tolerance_s) {
  return std::ranges::any_of(sweeps, [&](const Turned& sweep) {
    const bool begins = std::isinf(sweep.begin_s) || std::abs(sweep.begin_s - begin_s) < tolerance_s,
               ends = std::isinf(sweep.end_s) || std::abs(sweep.end_s - end_s) < tolerance_s;
    return begins && ends && sweep.begin_s < end_s && sweep.end_s > begin_s;
  });
}

// Whether the motion shifted by so many sweeps differs from what the motor did, for enough of the time.
bool shows_shift(const std::vector<Turned>& sweeps, std::size_t count, const RecordingPart& recorded) {
  constexpr double kTolerance = 0.1;   // of a sweep: 18 deg of half a turn
  constexpr double kMinDiffer = 0.02;  // of the sweeps: one of 24, to either side
  std::vector<double> shifts_s;
  for (std::size_t i = 0; i + count < sweeps.size(); ++i)
    if (sweeps[i].is_whole() && sweeps[i + count].is_whole())
      shifts_s.push_back(sweeps[i + count].begin_s - sweeps[i].begin_s);
  if (shifts_s.empty()) return false;
  const double shift_s = median(shifts_s);
  std::size_t compared = 0, differ = 0;
  for (const Turned& sweep : sweeps) {
    if (!sweep.is_whole()) continue;
    for (const double by_s : {shift_s, -shift_s}) {
      const double begin_s = sweep.begin_s + by_s, end_s = sweep.end_s + by_s;
      if (begin_s < recorded.begin_s || end_s > recorded.end_s) continue;
      ++compared;
      if (!turned_at(sweeps, begin_s, end_s, kTolerance * (end_s - begin_s))) ++differ;
    }
  }
  return double(differ) > kMinDiffer * double(compared);
}

}  // namespace

double mirror_shift_s(const MotorTrack& track, const MotorMotion& motion) {
  constexpr std::size_t kMinSweeps =
      6;  // of fewer the shifted motion has too little in common with the other
  if (motion.sweeps.size() < kMinSweeps) return motion.median_sweep_s;
  const std::vector<Turned> sweeps = turned_of(track, motion);
  const bool all = sweeps.size() == motion.sweeps.size();
  const RecordingPart recorded{track.time_s.front(), all ? track.time_s.back() : sweeps.back().end_s};
  std::size_t count = 1;
  while (2 * count < sweeps.size() && shows_shift(sweeps, count, recorded)) ++count;
  return double(count) * motion.median_sweep_s;
}

}  // namespace sweepscope
