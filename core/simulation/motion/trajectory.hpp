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
  Vector3d position_m = Vector3d::Zero();                           // of the base in the world
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_base
};

/// A walk: through the waypoints in plan, from rest to rest, its rig at `height_m`. Duration, length and tops
/// are those of the walk that comes out, measured as WalkMeasure says; the plan is scaled by a few per cent
/// to fit.
struct WalkSpec {
  std::vector<Vector2d> waypoints_m;  // corners of the way, which it rounds
  bool closed = true;                 // ends where it began
  double height_m = 1.5;              // of the base above the ground
  double duration_s = 0, length_m = 0, top_speed_mps = 0, top_angular_rate_radps = 0;  // of the whole walk
};

/// The pose of a stationary recording.
struct Stand {
  Vector3d position_m = Vector3d::Zero();  // of the base in the world
  double yaw_deg = 0;                      // of the base about z
  double pitch_deg = 0;                    // downwards
};

/// Of the base frame every 10 ms, swaying included.
struct WalkMeasure {
  double length_m = 0, top_speed_mps = 0, top_angular_rate_radps = 0;  // in the interval
};

/// Measures a motion in steps of 10 ms.
WalkMeasure measure(const std::function<Pose(double t_s)>& pose_at, double from_s, double to_s);

/// The pose of the base frame over true time; before 0 and after the duration it rests.
class Trajectory {
 public:
  /// `seed` sets the phases of the swaying. The walk is fitted to its specification here.
  Trajectory(const WalkSpec& walk, std::uint64_t seed);
  /// A base that stands.
  explicit Trajectory(const Stand& stand);
  /// A motion of any kind.
  explicit Trajectory(std::function<Pose(double t_s)> motion);
  ~Trajectory();
  /// Movable, not copied.
  Trajectory(Trajectory&&) noexcept;
  /// Movable, not copied.
  Trajectory& operator=(Trajectory&&) noexcept;

  /// world_from_base at a time on the clock of the laser.
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
