#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/geometry/gear.hpp"
#include "core/geometry/kinematics.hpp"

namespace sweepscope {

enum class StampSource { kHeader, kReceive };
/// The instant of a scan that its stamp refers to.
enum class StampAt { kFirstBeam, kLastBeam, kArrival };
/// The echo of a beam that is used, of a scanner that reports several (sensor_msgs/MultiEchoLaserScan).
enum class Echo { kFirst, kLast, kStrongest };

/// As the rig file spells them.
inline std::string name_of(StampSource stamp) {
  return stamp == StampSource::kHeader ? "header" : "receive";
}
inline std::string name_of(StampAt stamp_at) {
  if (stamp_at == StampAt::kFirstBeam) return "first_beam";
  return stamp_at == StampAt::kLastBeam ? "last_beam" : "arrival";
}
inline std::string name_of(Echo echo) {
  if (echo == Echo::kFirst) return "first";
  return echo == Echo::kLast ? "last" : "strongest";
}

/// The rig that made a recording: the rig file. Empty members are detected from the recording.
struct Rig {
  struct Laser {
    std::optional<std::string> topic;
    std::optional<std::string> field;  // that holds the scan, in a message of another type
    Echo echo = Echo::kFirst;
    std::optional<StampSource> stamp;
    StampAt stamp_at = StampAt::kFirstBeam;
    std::optional<double> time_increment_s;  // used if the recording's is 0 or in doubt
  };
  struct Motor {
    std::optional<std::string> topic;
    std::optional<std::string> field;  // that holds the angle, in a message of any type: "position[2]"
    std::optional<std::string> joint;
    std::optional<StampSource> stamp;
    double scale = 1.0;  // angle_rad = scale * raw - zero_deg * pi / 180
    double zero_deg = 0.0;
  };
  using Mount = sweepscope::Mount;
  /// An IMU (sensor_msgs/Imu) on the base, whose gyroscope is a prior of a moving rig's rotation.
  struct Imu {
    std::optional<std::string> topic;  // none: no IMU is used
    // p_in_base = R(rpy) * p_in_imu + xyz; the position has no effect on a rotation.
    Eigen::Vector3d pose_in_base_xyz_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d pose_in_base_rpy_deg = Eigen::Vector3d::Zero();
  };
  /// nav_msgs/Odometry of the base frame, a prior of a moving rig's trajectory.
  struct Odometry {
    std::optional<std::string> topic;  // none: no odometry is used
  };
  /// What lies between the encoder's angle and the laser's: see Gear. The shown angle is the shaft's plus
  /// amplitude sin(angle + phase).
  struct Gear {
    double play_deg = 0;               // >= 0
    double encoder_amplitude_deg = 0;  // >= 0
    double encoder_phase_deg = 0;
    sweepscope::Gear angles() const;
  };
  Laser laser;
  Motor motor;
  Mount mount;
  Gear gear;
  Imu imu;
  Odometry odometry;
};

/// Reads a rig file (YAML; see assets/rigs). Unknown keys and invalid values are errors with line and column.
Result<Rig> read_rig(const std::filesystem::path& path);

}  // namespace sweepscope
