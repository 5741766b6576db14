#include "core/loam/path/agreement.hpp"

#include <algorithm>

namespace sweepscope {
namespace {

// By how much two good tracks differ over a window: more where the rig moves further. Tuned on
// tests/benchmark/worlds.
constexpr double kWindow_s = 2, kShift_m = 0.1, kShiftOfWay = 0.04, kTurn_rad = 0.05;

// Of an even number of sweeps: a map that is bent (see straighten.hpp) bends the poses alike at the beginning
// of each sweep of one direction.
Pose motion_over(std::span<const SweepPose> window) {
  return window.front().begin().inverse() * window.back().end();
}

bool agree(std::span<const SweepPose> a, std::span<const SweepPose> b) {
  const auto lost = [](std::span<const SweepPose> window) {
    return std::ranges::any_of(window, &SweepPose::lost);
  };
  if (lost(a) || lost(b)) return false;
  const Pose of_a = motion_over(a), of_b = motion_over(b);
  const double shift_m = (of_a.translation_m - of_b.translation_m).norm();
  return shift_m < kShift_m + kShiftOfWay * std::min(of_a.translation_m.norm(), of_b.translation_m.norm()) &&
         turn_between(of_a.rotation, of_b.rotation).norm() < kTurn_rad;
}

}  // namespace

std::vector<char> agreeing(std::span<const SweepPose> a, std::span<const SweepPose> b) {
  std::vector<char> found(a.size(), 0);
  for (std::size_t first = 0; first < a.size(); ++first) {
    std::size_t count = 2;
    while (first + count <= a.size() && a[first + count - 1].end_s - a[first].begin_s < kWindow_s) count += 2;
    if (first + count > a.size()) break;
    if (agree(a.subspan(first, count), b.subspan(first, count)))
      std::fill_n(found.begin() + std::ptrdiff_t(first), count, 1);
  }
  return found;
}

}  // namespace sweepscope
