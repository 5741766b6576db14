#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/pose.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Whether a trajectory from elsewhere covers a recording's scans, from their first beam to their last.
/// `used` says for each scan whether it counts; empty: all do. A trajectory that covers none of them is
/// ExitCode::kNotIdentifiable, with both spans of time. Else a warning that counts the scans that are left
/// out; empty where none is.
Result<std::string> check_pose_coverage(const Recording& recording, std::span<const StampedPose> poses,
                                        std::span<const char> used = {});

}  // namespace sweepscope
