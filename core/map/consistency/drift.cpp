#include "core/map/consistency/drift.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// Tuned on 78 worlds of tests/benchmark/worlds, of the seeds 20 to 22, 30, 40, 41, 60, 70 and 71.
constexpr double kMinFacing = 0.6;     // matches
constexpr double kSpeedChange = 0.25;  // m/s in a second; the speed is taken for a random walk

// Between two views. At an end of the recording, from there.
DriftingTime drifting_time(const std::vector<WalkView>& views, std::size_t first, std::size_t last) {
  const bool at_begin = first == 0, at_end = last + 1 == views.size();
  const double begin_s = views.front().begin_s, all_s = views.back().end_s - begin_s;
  DriftingTime time;
  time.at_s = {at_begin ? begin_s : views[first].middle_s(),
               at_end ? begin_s + all_s : views[last].middle_s()};
  time.place_m = views[(first + last + 1) / 2].at.translation_m;
  const double time_s = time.at_s.end_s - time.at_s.begin_s;
  if (at_begin || at_end) {  // one speed is known, and the error grows from there
    time.drift_m = kSpeedChange * std::sqrt(std::pow(time_s, 3) / 3);
    time.rmse_m = time.drift_m / 2 * std::sqrt(time_s / all_s);
  } else {  // what is before it and what is after it lie apart
    const double before = (time.at_s.begin_s + time_s / 2 - begin_s) / all_s;
    time.drift_m = kSpeedChange * std::sqrt(std::pow(time_s, 3) / 12);
    time.rmse_m = time.drift_m * std::sqrt(before * (1 - before));
  }
  return time;
}

// Of the moves to each view from the one before it those that nothing shows.
std::vector<std::optional<WeakestDirection>> free_moves(std::size_t views,
                                                        const std::vector<FacedMove>& moves) {
  std::vector<std::optional<WeakestDirection>> free(views);
  for (const FacedMove& move : moves)
    if (move.to == move.from + 1 && move.weakest.facing < kMinFacing) free[move.to] = move.weakest;
  for (const FacedMove& move : moves)
    if (move.to == move.from + 2 && move.weakest.facing >= kMinFacing) {
      free[move.to].reset();
      free[move.to - 1].reset();
    }
  return free;
}

}  // namespace

std::vector<DriftingTime> drifting_times(const std::vector<WalkView>& views,
                                         const std::vector<FacedMove>& moves) {
  const auto free = free_moves(views.size(), moves);
  std::vector<DriftingTime> times;
  for (std::size_t i = 1; i < views.size(); ++i) {
    if (!free[i]) continue;
    const std::size_t first = i - 1;
    WeakestDirection weakest = *free[i];
    for (; i + 1 < views.size() && free[i + 1]; ++i)
      if (free[i + 1]->facing < weakest.facing) weakest = *free[i + 1];
    const Vector3d moved_m = views[i].at.translation_m - views[first].at.translation_m;
    DriftingTime& time = times.emplace_back(drifting_time(views, first, i));
    time.direction = (weakest.direction.dot(moved_m) < 0 ? -1 : 1) * weakest.direction;
  }
  return times;
}

std::optional<std::string> drift_warning(const std::vector<DriftingTime>& drifting, double limit_m) {
  if (drifting.empty()) return std::nullopt;
  const DriftingTime& worst = *std::ranges::max_element(drifting, {}, &DriftingTime::rmse_m);
  if (worst.rmse_m <= limit_m) return std::nullopt;
  const Vector3d along = (100 * worst.direction).array().round() / 100 + 0.0;  // never "-0.00"
  return fmt::format(
      "From {:.0f} to {:.0f} s, near ({:.1f}, {:.1f}, {:.1f}) m, nothing in view shows how far the rig moved "
      "along ({:.2f}, {:.2f}, {:.2f}). The map may be wrong there by {:.1f} m in this direction.",
      worst.at_s.begin_s, worst.at_s.end_s, worst.place_m.x(), worst.place_m.y(), worst.place_m.z(),
      along.x(), along.y(), along.z(), worst.drift_m);
}

}  // namespace sweepscope
