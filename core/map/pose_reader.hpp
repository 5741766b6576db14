#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/pose.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Poses that ascend in time, read at ascending times. Must not outlive the poses.
class PoseReader {
 public:
  explicit PoseReader(const std::vector<StampedPose>& poses) : poses_(poses) {}

  bool covers(double from_s, double to_s) const {
    return poses_.size() > 1 && from_s >= poses_.front().time_s && to_s <= poses_.back().time_s;
  }
  /// Interpolates linearly; only for times that the poses cover.
  Pose at(double time_s) {
    while (next_ + 1 < poses_.size() && poses_[next_].time_s < time_s) ++next_;
    while (next_ > 1 && poses_[next_ - 1].time_s > time_s) --next_;
    const StampedPose &a = poses_[next_ - 1], &b = poses_[next_];
    return interpolate({a.orientation, a.position_m}, {b.orientation, b.position_m},
                       (time_s - a.time_s) / (b.time_s - a.time_s));
  }

 private:
  const std::vector<StampedPose>& poses_;
  std::size_t next_ = 1;
};

/// Whether a trajectory from elsewhere covers a recording's scans, from their first beam to their last.
/// `used` says for each scan whether it is used; empty: all are. A trajectory that covers none of them is
/// ExitCode::kNotIdentifiable, with both spans of time. Otherwise a warning with the number of scans that are
/// left out; empty if there are none.
Result<std::string> check_pose_coverage(const Recording& recording, std::span<const StampedPose> poses,
                                        std::span<const char> used = {});

}  // namespace sweepscope
