#include "core/loam/path/agreement.hpp"

#include <algorithm>

namespace sweepscope {
namespace {

// By how much two good tracks differ over a window: more where the rig moves further. Tuned on
// tests/benchmark/worlds.
constexpr double kWindow_s = 2, kShift_m = 0.1, kShiftOfWay = 0.04, kTurn_rad = 0.05;

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
  for (std::size_t first = 0, end = 0; first < a.size(); ++first) {
    while (end < a.size() && (end - first < 2 || a[end - 1].end_s - a[first].begin_s < kWindow_s || (end - first) % 2 == 1)) ++end;
    const bool whole = (end - first) % 2 == 0 && end > first && (a[end - 1].end_s - a[first].begin_s >= kWindow_s || first == 0);
    if (whole && agree(a.subspan(first, end - first), b.subspan(first, end - first)))
      std::fill(found.begin() + std::ptrdiff_t(first), found.begin() + std::ptrdiff_t(end), 1);
  }
  return found;
}

}  // namespace sweepscope
