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

/// The two streams of a scanner that a motor turns in a scene. True time is the laser's clock, 0 at the first
/// beam of the first scan.
class Sensor {
 public:
  Sensor(const SimulationOptions& options, const Scene& scene);

  /// The times and angles of a scan: the turn of the mirror, or a part of one. Beams are in the order in
  /// which they are fired; the stamp is a whole number of nanoseconds. `first_range` is that within its turn.
  LaserScan scan(std::size_t turn, std::uint32_t part = 0) const;
  /// Fires the rays of one turn, each at its own instant: beam after beam, of a 3D scanner the rings of a
  /// beam together. NaN if there is no usable return.
  void cast_turn(std::size_t turn, std::span<float> ranges_m, std::span<float> intensities) const;
  /// The encoder's samples from a little before true time 0 to a little after duration_s.
  MotorTrack motor_track(double duration_s) const;
  /// Of the base frame.
  Pose pose_at(double t_s) const;
  /// When a ray is fired, after the turn's begin, and its direction in the laser's frame.
  double fired_s(std::uint32_t ray) const;
  Vector3d direction(std::uint32_t ray) const;
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
  Return fire(std::size_t turn, std::uint32_t ray, float& intensity) const;
  /// The first beam of a part of a turn, and the part that a beam belongs to.
  std::uint32_t first_beam(std::uint32_t part) const;
  std::uint32_t part_of(std::uint32_t beam) const;
  /// The number in the message's array of the beam that is fired as number `beam` of its turn.
  std::uint32_t array_index(std::uint32_t beam) const;
  double angle_rad(std::uint32_t array_index) const;
  /// v_in_world of a vector in the frame that turns with the motor.
  Vector3d from_motor(const Pose& pose, double t_s, const Vector3d& in_motor) const;

  SimulationOptions options_;
  RayCaster caster_;
  Trajectory trajectory_;
  Motor motor_;
  double encoder_phase_s_ = 0;
  Glass glass_;
  std::vector<Person> people_;
  std::vector<Vector3d> ray_directions_;  // in the frame that turns with the motor, in the order of firing
};

}  // namespace sweepscope::simulation
