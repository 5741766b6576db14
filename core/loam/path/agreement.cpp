#include "core/loam/path/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

// By how much two good tracks differ over a window: more where the rig moves further. Tuned on
// tests/benchmark/worlds.
constexpr double kWindow_s = 2, kShift_m = 0.1, kShiftOfWay = 0.04, kTurn_rad = 0.05;
// Farther apart, one of two tracks is wrong: good ones were up to 0.6 m apart where they did not agree, and
// those that erred 1.9 m and more (worlds of the seeds 20 to 23).
constexpr double kContradiction_m = 1;

// Of an even number of sweeps: a map that is bent (see straighten.hpp) bends the poses alike at the beginning
// of each sweep of one direction.
Pose motion_over(std::span<const SweepPose> window) {
  return window.front().begin().inverse() * window.back().end();
}

bool any_lost(std::span<const SweepPose> part) {
  return std::ranges::any_of(part, &SweepPose::lost);
}

bool agree(std::span<const SweepPose> a, std::span<const SweepPose> b) {
  if (any_lost(a) || any_lost(b)) return false;
  const Pose of_a = motion_over(a), of_b = motion_over(b);
  const double shift_m = (of_a.translation_m - of_b.translation_m).norm();
  return shift_m < kShift_m + kShiftOfWay * std::min(of_a.translation_m.norm(), of_b.translation_m.norm()) &&
         turn_between(of_a.rotation, of_b.rotation).norm() < kTurn_rad;
}

// Sweeps [first, end) of a track.
struct Part {
  std::size_t first, end;

  template <typename T>
  std::span<const T> of(std::span<const T> track) const {
    return track.subspan(first, end - first);
  }
};

// Of an even number of sweeps, see motion_over.
Part widened(Part part, std::size_t sweeps) {
  if ((part.end - part.first) % 2 == 0) return part;
  if (part.end < sweeps) return {part.first, part.end + 1};
  return {part.first > 0 ? part.first - 1 : 0, part.end};
}

// Takes a part of another track, and moves what follows along.
void splice(std::vector<SweepPose>& poses, Part part, std::span<const SweepPose> other) {
  const Pose to_here = poses[part.first].begin() * other[part.first].begin().inverse();
  const Pose moved = to_here * other[part.end - 1].end() * poses[part.end - 1].end().inverse();
  for (std::size_t i = part.first; i < poses.size(); ++i) {
    const bool taken = i < part.end;
    if (taken) poses[i].knots = other[i].knots;
    for (Pose& knot : poses[i].knots) knot = (taken ? to_here : moved) * knot;
  }
}

void mend(MendedTrack& track, Part part, const std::vector<JudgedTrack>& others) {
  const std::span<const SweepPose> own(track.poses);
  if (any_lost(part.of(own))) return;
  const Pose motion = motion_over(part.of(own));
  Apart nearest{std::numeric_limits<double>::infinity()};
  const JudgedTrack* confirmed = nullptr;
  for (const JudgedTrack& other : others) {
    if (any_lost(part.of(other.poses))) continue;
    nearest = std::min(nearest, ends_apart(motion_over(part.of(other.poses)), motion), nearer);
    if (!confirmed && std::ranges::count(part.of(other.agreed), 0) == 0) confirmed = &other;
  }
  if (!std::isfinite(nearest.shift_m) || nearest.together_m() <= kContradiction_m) return;
  if (!confirmed || confirmed->earlier)
    track.contradictions.push_back({own[part.first].begin_s, own[part.end - 1].end_s, nearest});
  if (!confirmed) return;
  splice(track.poses, part, confirmed->poses);
  std::fill(track.agreed.begin() + std::ptrdiff_t(part.first),
            track.agreed.begin() + std::ptrdiff_t(part.end), char(1));
}

}  // namespace

Apart ends_apart(const Pose& a, const Pose& b) {
  return {(a.translation_m - b.translation_m).norm(), turn_between(a.rotation, b.rotation).norm()};
}

bool nearer(const Apart& a, const Apart& b) {
  return a.together_m() < b.together_m();
}

std::string in_words(const Contradiction& tracks, double first_s) {
  const double turn_deg = tracks.apart.turn_rad * kDegPerRad;
  return fmt::format(
      "From {:.0f} to {:.0f} s the surfaces hardly determine the motion: tracked in two ways, it ends {:.1f} m "
      "{}apart. The trajectory may be wrong there.",
      std::max(0.0, tracks.begin_s - first_s), tracks.end_s - first_s, tracks.apart.shift_m,
      turn_deg < 1 ? "" : fmt::format("and {:.0f} deg ", turn_deg));
}

MendedTrack mended(std::vector<SweepPose> poses, std::vector<char> agreed,
                   const std::vector<JudgedTrack>& others) {
  MendedTrack track{std::move(poses), std::move(agreed), {}};
  const std::size_t sweeps = track.agreed.size();
  for (std::size_t first = 0; first < sweeps; ++first) {
    std::size_t end = first;
    while (end < sweeps && track.agreed[end] == 0) ++end;
    if (end == first) continue;
    mend(track, widened({first, end}, sweeps), others);
    first = end;
  }
  return track;
}

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
