#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/recording/recording.hpp"
#include "core/simulation/meshes/ray_caster.hpp"
#include "core/simulation/motion/motor.hpp"
#include "core/simulation/motion/trajectory.hpp"
#include "core/simulation/scenes/glass.hpp"
#include "core/simulation/scenes/people.hpp"
#include "core/simulation/scenes/scene.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope::simulation {

/// The two streams of a UTM-30LX that a motor rolls in a scene. True time is the laser's clock, 0
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
  /// Fires every beam of a scan at its own time. NaN if there is no usable return.
  void cast_scan(std::size_t number, std::span<float> ranges_m, std::span<float> intensities) const;
  /// The encoder's samples from a little before true time 0 to a little after duration_s.
  MotorTrack motor_track(double duration_s) const;
  /// Of the base frame.
  Pose pose_at(double t_s) const;
  /// The origin of the beams: not the base frame's if the mount has an error.
  Vector3d laser_position_at(double t_s) const;
  const RayCaster& surroundings() const { return caster_; }
  /// The people that the beams meet from now on.
  void set_people(std::vector<Person> people) { people_ = std::move(people); }

 private:
  /// The return of a beam before noise: infinite if there is none.
  struct Return {
    double range_m = std::numeric_limits<double>::infinity();
    double lost = 0;  // probability that the return is too weak
  };
  /// The reading of an ideal encoder without steps.
  double encoder_angle_rad(double t_s) const;
  Return fire(std::size_t number, std::size_t beam, float& intensity) const;
  /// v_in_world of a vector in the frame that turns with the motor.
  Vector3d from_motor(const Pose& pose, double t_s, const Vector3d& in_motor) const;

  SimulationOptions options_;
  RayCaster caster_;
  Trajectory trajectory_;
  Motor motor_;
  double encoder_phase_s_ = 0;
  Glass glass_;
  std::vector<Person> people_;
  std::vector<Vector3d> beam_directions_;  // in the frame that turns with the motor
};

}  // namespace sweepscope::simulation
