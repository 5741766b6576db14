#pragma once

#include <functional>
#include <string>

#include "core/recording/assemble/assemble.hpp"
#include "core/recording/messages/message_collector.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/recording/message_bytes.hpp"

namespace sweepscope::test {

/// A 3D scanner that spins about its z axis, tilted about an axis by a slow motor, as the messages that its
/// driver and its motor's would send: made from rays alone, independently of what the program computes.
struct CloudBench {
  simulation::Mesh mesh = hall();
  std::function<Eigen::Isometry3d(double t_s)> world_from_base = [](double) {
    return Eigen::Isometry3d::Identity();
  };
  int rings = 16;
  double ring_spacing_deg = 2;
  bool ring_field = true;
  /// Who sends the clouds: a driver with a PointCloud2 whose times are floating seconds, or whole
  /// nanoseconds, or one of Livox's drivers with its own message.
  enum class Driver { kSeconds, kNanoseconds, kLivox, kLivox2 };
  Driver driver = Driver::kSeconds;
  /// Instead of rings round the z axis lines along one path about the x axis that does not repeat itself, as
  /// two prisms that turn lay it.
  bool rosette = false;
  int beams = 450;  // of a ring and turn
  double turn_s = 0.1;
  bool clockwise = true;  // seen from above
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  Eigen::Vector3d laser_in_motor_m{0.05, 0, 0.08};
  double offset_s = 0.0243;
  double sweep_s = 2.057, swing_deg = 45;
  double duration_s = 18.5;
  double noise_m = 0.01;
  double encoder_step_deg = 0.02;
  std::uint64_t seed = 1;

  static constexpr double kStart_s = 1'700'000'000;

  double angle_rad(double t_s) const;

  using Take = std::function<void(const char* topic, const char* type, std::int64_t receive_ns,
                                  const std::string& bytes)>;
  /// All messages in the order of their receipt, as ROS 2 has them.
  void play(MessageBytes::Form form, const Take& take) const;

  Rig rig() const;
  /// What a file with these messages reads as.
  RawRecording raw(CloudDetail detail = CloudDetail::kLines) const;
  Recording record() const;

 private:
  void play_motor(int sample, MessageBytes::Form form, const Take& take) const;
  const char* cloud_type() const;
  std::string cloud(const simulation::RayCaster& caster, int turn, MessageBytes::Form form,
                    std::uint32_t seconds, std::uint32_t nanoseconds) const;
  using Add = std::function<void(const Eigen::Vector3f& p_in_laser_m, double since_s, int ring)>;
  void cast_turn(const simulation::RayCaster& caster, int turn, const Add& add) const;
};

/// A walk in the hall: to and fro between its pillars, turning and swaying a little.
Eigen::Isometry3d walk_in_hall(double t_s);

}  // namespace sweepscope::test
