#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/recording/recording.hpp"
#include "core/simulation/motor.hpp"
#include "core/simulation/ray_caster.hpp"
#include "core/simulation/scene.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/trajectory.hpp"

namespace sweepscope::simulation {

/// A UTM-30LX rolled by a motor through a scene: what its two streams say. True time is the laser's clock, 0
/// at the first beam of the first scan.
class Sensor {
 public:
  static constexpr std::size_t kBeams = 721;
  static constexpr double kScanPeriod_s = 0.025;
  static constexpr float kTimeIncrement_s = 1.736e-5F;
  static constexpr float kAngleMin_rad = -1.57079632679489661923F;
  static constexpr float kAngleIncrement_rad = 0.00436332312998582394F;
  static constexpr double kRangeMin_m = 0.1, kRangeMax_m = 30;

  Sensor(const SimulationOptions& options, const Scene& scene);

  /// A scan's times and angles; its stamp is a whole number of nanoseconds.
  LaserScan scan(std::size_t number) const;
  /// Fires every beam of a scan at its own instant. NaN where nothing usable returns.
  void cast_scan(std::size_t number, std::span<float> ranges_m, std::span<float> intensities) const;
  /// The encoder's samples from a little before true time 0 to a little after duration_s.
  MotorTrack motor_track(double duration_s) const;
  Pose pose_at(double t_s) const;

 private:
  Vector3d direction_in_world(const Pose& pose, double t_s, std::size_t beam) const;

  SimulationOptions options_;
  RayCaster caster_;
  Trajectory trajectory_;
  Motor motor_;
  double encoder_phase_s_ = 0;
  std::vector<Vector2d> beam_directions_;  // in the laser's plane
};

}  // namespace sweepscope::simulation
