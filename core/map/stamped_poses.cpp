#include "core/map/stamped_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace sweepscope {
namespace {

/// As files have it, in seconds: a double does not hold milliseconds beside a time of today.
std::string stamp_text(const Recording& recording, double time_s) {
  const std::int64_t ms = (recording.epoch_ns + std::llround(time_s * 1e9)) / 1'000'000;
  return fmt::format("{}{}.{:03}", ms < 0 ? "-" : "", std::abs(ms) / 1000, std::abs(ms) % 1000);
}

std::string span_text(const Recording& recording, double from_s, double to_s) {
  return fmt::format("from {} to {} s", stamp_text(recording, from_s), stamp_text(recording, to_s));
}

}  // namespace

bool poses_cover(std::span<const StampedPose> poses, double from_s, double to_s) {
  return poses.size() > 1 && from_s >= poses.front().time_s && to_s <= poses.back().time_s;
}

Pose pose_at(std::span<const StampedPose> poses, double time_s) {
  const auto later = std::lower_bound(poses.begin() + 1, poses.end() - 1, time_s,
                                      [](const StampedPose& pose, double t_s) { return pose.time_s < t_s; });
  const StampedPose &a = *(later - 1), &b = *later;
  return interpolate({a.orientation, a.position_m}, {b.orientation, b.position_m},
                     (time_s - a.time_s) / (b.time_s - a.time_s));
}

Result<std::string> check_pose_coverage(const Recording& recording, std::span<const StampedPose> poses,
                                        std::span<const char> used) {
  if (poses.size() < 2)
    return unreadable(fmt::format("{}: a trajectory needs at least two poses", recording.name));
  std::size_t scans = 0, covered = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    if (!used.empty() && used[i] == 0) continue;
    const LaserScan& scan = recording.scans[i];
    ++scans;
    covered += poses_cover(poses, scan.first_beam_s, scan.last_beam_s()) ? 1 : 0;
  }
  const std::string of_poses = span_text(recording, poses.front().time_s, poses.back().time_s);
  if (covered == 0) {
    return failure(
        ExitCode::kNotIdentifiable,
        fmt::format("{}: no scan lies within the time of the poses: the poses are {}, the scans {}",
                    recording.name, of_poses,
                    span_text(recording, recording.scans.front().first_beam_s,
                              recording.scans.back().last_beam_s())));
  }
  if (covered == scans) return std::string();
  return fmt::format("{} of {} scans lie outside the time of the poses, {}, and are left out",
                     scans - covered, scans, of_poses);
}

}  // namespace sweepscope
