#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/pose.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Whether poses that ascend in time cover a span of time.
bool poses_cover(std::span<const StampedPose> poses, double from_s, double to_s);
/// The pose at a time that they cover, linear between those before and after it.
Pose pose_at(std::span<const StampedPose> poses, double time_s);

/// Whether a trajectory from elsewhere covers a recording's scans, from their first beam to their last.
/// `used` says for each scan whether it is used; empty: all are. A trajectory that covers none of them is
/// ExitCode::kNotIdentifiable, with both spans of time. Otherwise a warning with the number of scans that are
/// left out; empty if there are none.
Result<std::string> check_pose_coverage(const Recording& recording, std::span<const StampedPose> poses,
                                        std::span<const char> used = {});

}  // namespace sweepscope
