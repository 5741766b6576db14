#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/error.hpp"
#include "core/simulation/motion/spline_path.hpp"

namespace sweepscope::simulation {

/// How a recorded motion is put into a scene.
struct PathPlacement {
  double scale = 1;              // of the positions, about their mean
  std::optional<Vector3d> at_m;  // new position of their mean; absent: unchanged
  double yaw_deg = 0;            // turned about the vertical through their mean
  bool upright = false;          // the rig is rotated in the recorded frame so that it is level on average
  double smoothing_s = 0.05;     // between the spline's knots
};

/// A recorded motion as a walk through a scene; true time 0 is `start_s` on the path's clock.
struct RecordedPath {
  std::shared_ptr<const SplinePath> path;  // through the placed poses
  double start_s = 0, duration_s = 0;      // of the part that is used
  SplineDeviation deviation;               // of the spline from the poses

  /// The pose at a true time.
  Pose at(double t_s) const { return path->at(start_s + t_s); }
};

/// The poses, placed: scaled, turned and moved. Equal to the input for a default placement.
std::vector<StampedPose> placed(std::span<const StampedPose> poses, const PathPlacement& placement);

/// Reads a TUM file without its first from_s seconds. ExitCode::kUnreadableInput for fewer than 20 poses, a
/// gap of more than 1 s, or a turn of more than 60 deg from one pose to the next.
Result<RecordedPath> read_path(const std::filesystem::path& file, const PathPlacement& placement,
                               double from_s);

}  // namespace sweepscope::simulation
