#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/geometry/gear.hpp"
#include "core/geometry/kinematics.hpp"
#include "core/geometry/motor_profile.hpp"

namespace sweepscope {

/// The time of a message: its header's stamp, or when it was received.
enum class StampSource { kHeader, kReceive };
/// The instant of a scan that its stamp refers to.
enum class StampAt { kFirstBeam, kLastBeam, kArrival };
/// The unit of a motor's values, before `scale`.
enum class AngleUnit { kRad, kDeg, kTurns };
/// The echo of a beam that is used, of a scanner that reports several (sensor_msgs/MultiEchoLaserScan).
enum class Echo { kFirst, kLast, kStrongest };

/// As the rig file spells them.
inline std::string name_of(StampSource stamp) {
  return stamp == StampSource::kHeader ? "header" : "receive";
}
/// As the rig file spells them.
inline std::string name_of(StampAt stamp_at) {
  if (stamp_at == StampAt::kFirstBeam) return "first_beam";
  return stamp_at == StampAt::kLastBeam ? "last_beam" : "arrival";
}
/// As the rig file spells them.
inline std::string name_of(Echo echo) {
  if (echo == Echo::kFirst) return "first";
  return echo == Echo::kLast ? "last" : "strongest";
}
/// As the rig file spells them.
inline std::string name_of(AngleUnit unit) {
  if (unit == AngleUnit::kRad) return "rad";
  return unit == AngleUnit::kDeg ? "deg" : "turns";
}

/// The rig that made a recording: the rig file. Empty members are detected from the recording.
struct Rig {
  /// The scanner's messages.
  struct Laser {
    std::optional<std::string> topic;        // of its scans
    std::optional<std::string> field;        // that holds the scan, in a message of another type
    Echo echo = Echo::kFirst;                // where a beam has several
    std::optional<StampSource> stamp;        // which stamps are used
    StampAt stamp_at = StampAt::kFirstBeam;  // what they are the time of
    /// From beam to beam of a message's array. 0: all beams of a scan at once. Negative: the last beam of the
    /// array was fired first, and the stamp is that of the first beam fired. The recorded one is used, with
    /// this sign, where both differ by at most 25 %.
    std::optional<double> time_increment_s;
    bool increment_is_found = false;  // by the surfaces (core/offset/readings): nobody stated it
  };
  /// The motor's messages: angle_rad = rad_per_value() * value - zero_deg * pi / 180.
  struct Motor {
    std::optional<std::string> topic;  // of its messages
    std::optional<std::string> field;  // that holds the angle, in a message of any type: "position[2]"
    std::optional<std::string> joint;  // in messages with several
    std::optional<StampSource> stamp;  // which stamps are used
    double scale = 1.0;                // in units for each value of the recording
    AngleUnit unit = AngleUnit::kRad;  // of scale * value
    double zero_deg = 0.0;             // subtracted from the angle
    /// The messages on `topic`, or the rises of `field` where it has two values, mark a turn each.
    bool index = false;
    std::optional<MotorProfile> profile;  // then no message of a motor is used
    double rad_per_value() const;         // `scale` in rad
  };
  using Mount = sweepscope::Mount;  // how the laser sits on the motor, and the motor's axis
  bool mount_in_file = false;       // the rig file has the key
  /// Whether the mount is stated: by a rig file, or another one than that used without, which rolls about x.
  bool states_mount() const;
  /// An IMU (sensor_msgs/Imu) on the base, whose gyroscope is a prior of a moving rig's rotation.
  struct Imu {
    std::optional<std::string> topic;  // none: no IMU is used
    // p_in_base = R(rpy) * p_in_imu + xyz; the position has no effect on a rotation.
    Eigen::Vector3d pose_in_base_xyz_m = Eigen::Vector3d::Zero();
    // See pose_in_base_xyz_m.
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
    double encoder_phase_deg = 0;      // not determined where the amplitude is 0
    sweepscope::Gear angles() const;   // the same in rad
  };
  Laser laser;        // its messages
  Motor motor;        // its messages and the scale of its angles
  Mount mount;        // rolls about x unless stated or found
  Gear gear;          // play and encoder
  Imu imu;            // a prior of moving rigs
  Odometry odometry;  // likewise
};

/// Reads a rig file (YAML; see assets/rigs). Unknown keys and invalid values are errors with line and column.
Result<Rig> read_rig(const std::filesystem::path& path);

}  // namespace sweepscope
