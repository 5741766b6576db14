#include "core/map/scan_poses.hpp"

#include "core/map/stamped_poses.hpp"

namespace sweepscope {

ScanPoses::ScanPoses(const Recording& recording, const MapPath& path, double offset_s)
    : offset_s_(offset_s), pose_of_(recording.scans.size(), kNone) {
  std::vector<std::size_t> sweep_of = assign_sweeps(recording.scans, path.sweeps, offset_s);
  for (std::size_t i = 0; i < sweep_of.size(); ++i)
    if (path.used[i] == 0) sweep_of[i] = kNoSweep;
  if (!path.poses.empty()) {
    place_along(recording, path.poses, sweep_of);
  } else if (path.walk) {
    walk_ = path.walk;
    place_along_walk(sweep_of);
  } else {
    place_at_rest(path.sweeps, sweep_of);
  }
}

std::vector<StampedPose> ScanPoses::trajectory() const {
  std::vector<StampedPose> trajectory;
  for (const SweepPose& pose : poses()) {
    // A sweep's end and the next one's begin are one instant: a quarter in from each keeps the times apart.
    for (const double u : {0.25, 0.75}) {
      const Pose at = pose.at(u);
      trajectory.push_back({pose.begin_s + u * (pose.end_s - pose.begin_s), at.translation_m, at.rotation});
    }
  }
  return trajectory;
}

void ScanPoses::place_along(const Recording& recording, const std::vector<StampedPose>& poses,
                            const std::vector<std::size_t>& sweep_of) {
  for (std::size_t i = 0; i < sweep_of.size(); ++i) {
    const double begin_s = recording.scans[i].first_beam_s, end_s = recording.scans[i].last_beam_s();
    if (sweep_of[i] == kNoSweep || !(end_s > begin_s) || !poses_cover(poses, begin_s, end_s)) continue;
    SweepPose pose;
    pose.sweep = sweep_of[i];
    pose.begin_s = begin_s;
    pose.end_s = end_s;
    pose.knots = {pose_at(poses, begin_s), pose_at(poses, end_s)};
    pose_of_[i] = static_cast<std::uint32_t>(own_.size());
    own_.push_back(std::move(pose));
  }
}

void ScanPoses::place_along_walk(const std::vector<std::size_t>& sweep_of) {
  const std::vector<SweepPose>& poses = walk_->sweeps;
  std::size_t next = 0;
  for (std::size_t i = 0; i < sweep_of.size(); ++i) {
    if (sweep_of[i] == kNoSweep) continue;
    while (next < poses.size() && poses[next].sweep < sweep_of[i]) ++next;
    if (next < poses.size() && poses[next].sweep == sweep_of[i])
      pose_of_[i] = static_cast<std::uint32_t>(next);
  }
}

void ScanPoses::place_at_rest(const std::vector<Sweep>& sweeps, const std::vector<std::size_t>& sweep_of) {
  for (std::size_t i = 0; i < sweep_of.size(); ++i) {
    if (sweep_of[i] == kNoSweep) continue;
    if (own_.empty() || own_.back().sweep != sweep_of[i]) {
      const Sweep& sweep = sweeps[sweep_of[i]];
      SweepPose& pose = own_.emplace_back();
      pose.sweep = sweep_of[i];
      pose.direction = sweep.direction;
      pose.begin_s = sweep.begin_s - offset_s_;
      pose.end_s = sweep.end_s - offset_s_;
    }
    pose_of_[i] = static_cast<std::uint32_t>(own_.size() - 1);
  }
}

}  // namespace sweepscope
