#pragma once

// The mathematics: docs/algorithms.md, section 12.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/prepared/given_poses.hpp"
#include "core/offset/search/answer.hpp"
#include "core/offset/walk/time_shift.hpp"

namespace sweepscope {

/// The source of a motion, and the motion without a time shift.
struct MotionSource {
  UsedMotion::Kind kind = UsedMotion::Kind::kPoses;
  std::string name;  // the file or the topic
  GivenMotion motion;

  /// What an Estimate says of it.
  UsedMotion used(const std::optional<TimeShift>& shift) const;
};

/// The source that an estimate uses: the given poses, otherwise the recording's odometry, otherwise its IMU.
/// Absent if there is none of these.
std::optional<MotionSource> motion_source(const Recording& recording, const std::optional<GivenPoses>& poses);

/// A source's motion with its time shift, as far as it is known before the offset.
struct AlignedMotion {
  std::shared_ptr<const GivenMotion> motion;  // null: a prior that is not used
  std::optional<TimeShift> shift;             // none: not clear
  std::vector<std::string> warnings;
};

/// Finds the time shift: the walk is solved for, without help first, and its turns are correlated with the
/// source's. Where that leaves a doubt, a prior is not used, and the truth's shift is taken to be near 0,
/// each with a warning. Poses of another time whose turns do not say where they belong are
/// ExitCode::kUnreadableInput; an interruption is ExitCode::kInterrupted.
Result<AlignedMotion> align_motion(const OffsetProblem& problem, double offset_s,
                                   const MappingOptions& mapping, const MotionSource& source, const Job& job);

}  // namespace sweepscope
