#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/simulation/meshes/mesh.hpp"

namespace sweepscope::simulation {

/// The base frame (x forward, y left, z up) in the world.
struct Pose {
  Vector3d position_m = Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// A walk: through the waypoints in plan, from rest to rest, its rig at `height_m`. Duration, length and tops
/// are those of the walk that comes out, measured as WalkMeasure says; the plan is scaled by a few per cent
/// to fit.
struct WalkSpec {
  std::vector<Vector2d> waypoints_m;
  bool closed = true;  // ends where it began
  double height_m = 1.5;
  double duration_s = 0, length_m = 0, top_speed_mps = 0, top_angular_rate_radps = 0;
};

/// The pose of a stationary recording.
struct Stand {
  Vector3d position_m = Vector3d::Zero();
  double yaw_deg = 0;
  double pitch_deg = 0;  // downwards
};

/// Of the base frame every 10 ms, swaying included.
struct WalkMeasure {
  double length_m = 0, top_speed_mps = 0, top_angular_rate_radps = 0;
};

WalkMeasure measure(const std::function<Pose(double t_s)>& pose_at, double from_s, double to_s);

/// The pose of the base frame over true time; before 0 and after the duration it rests.
class Trajectory {
 public:
  /// `seed` sets the phases of the swaying. The walk is fitted to its specification here.
  Trajectory(const WalkSpec& walk, std::uint64_t seed);
  explicit Trajectory(const Stand& stand);
  /// A motion of any kind.
  explicit Trajectory(std::function<Pose(double t_s)> motion);
  ~Trajectory();
  Trajectory(Trajectory&&) noexcept;
  Trajectory& operator=(Trajectory&&) noexcept;

  Pose at(double t_s) const;
  /// How much the plan was scaled to reach the length asked for.
  double plan_scale() const;

 private:
  class Walk;
  std::unique_ptr<Walk> walk_;
  std::function<Pose(double t_s)> motion_;  // neither of the two: stands
  Pose stand_;
};

}  // namespace sweepscope::simulation
