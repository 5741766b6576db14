#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sweepscope {

/// The messages that an actuated scanner is recorded with, as ROS 1 and ROS 2 serialise them. Each decoder is
/// bounded: a length beyond the message's end, or excess bytes, make it malformed, and nothing is allocated
/// for it. A message's struct points to texts and arrays: after decoding into the message's bytes.

/// How a message is serialised: by ROS 1, or by ROS 2 as plain CDR (XCDR1) of either byte order.
enum class Encoding { kRos1, kCdr };

enum class MessageKind {
  kLaserScan,
  kMultiEcho,  // a scan with several echoes per beam
  kCloud,
  kLivox,  // a cloud in the own format of Livox scanners' drivers
  kJointState,
  kFields,  // any other type, read by its definition, with a header before its fields
  kFieldsWithoutHeader,
  kTransforms,
  kImu,
  kOdometry
};

/// A message of a 3D scanner, which CloudReader reads.
inline bool is_cloud(MessageKind kind) {
  return kind == MessageKind::kCloud || kind == MessageKind::kLivox;
}
inline bool is_scan(MessageKind kind) {
  return kind == MessageKind::kLaserScan || kind == MessageKind::kMultiEcho;
}
inline bool is_laser(MessageKind kind) {
  return is_scan(kind) || is_cloud(kind);
}
/// Of the rig itself.
inline bool is_motion(MessageKind kind) {
  return kind == MessageKind::kImu || kind == MessageKind::kOdometry;
}

struct MessageType {
  std::string_view name;  // as in ROS 1: package/Type
  std::string_view md5;   // of its ROS 1 definition
  MessageKind kind;
};

/// The type with that name, in ROS 1's spelling or in ROS 2's (package/msg/Type); null if it is not one of
/// these.
const MessageType* find_message_type(std::string_view name);

/// A type's name in ROS 1's spelling.
std::string short_type_name(std::string_view name);

/// Numbers in a message, at any alignment.
template <typename T>
struct PackedArray {
  std::span<const std::byte> bytes;
  bool swapped = false;  // big-endian

  std::size_t size() const { return bytes.size() / sizeof(T); }
  T operator[](std::size_t i) const;
  void append_to(std::vector<T>& numbers) const;
};

struct ScanMessage {
  std::int64_t header_ns = 0;
  std::string_view frame;
  float angle_min_rad = 0, angle_max_rad = 0, angle_increment_rad = 0;
  float time_increment_s = 0, scan_time_s = 0;
  float range_min_m = 0, range_max_m = 0;
  PackedArray<float> ranges_m, intensities;
};

/// A number of every point of a cloud.
struct CloudField {
  std::string_view name;
  std::uint32_t offset = 0;   // in a point's bytes
  std::uint8_t datatype = 0;  // as sensor_msgs/PointField numbers them
  std::uint32_t count = 1;    // of an array the first number is taken

  std::size_t size() const;  // 0: an unknown type
  bool whole_number() const { return datatype < 7; }
};

struct CloudMessage {
  std::int64_t header_ns = 0;
  std::string_view frame;
  std::uint32_t height = 0, width = 0, point_bytes = 0, row_bytes = 0;
  std::vector<CloudField> fields;
  std::span<const std::byte> data;
  bool swapped = false;        // big-endian
  bool dense = false;          // as stated in the message: no point is invalid
  double time_unit_s = 0;      // of the points' times, if the format states it; otherwise 0
  bool has_time_base = false;  // header_ns is the points' own, since 1970, and not the header's

  std::size_t points() const { return std::size_t{height} * width; }
  double value(std::size_t point, const CloudField& field) const;
};

/// One joint's position in a message; without a header 0 ns.
struct DecodedJoint {
  std::int64_t header_ns = 0;
  std::string_view name;
  double position = 0;
};

/// A frame's pose in its parent frame.
struct TransformMessage {
  std::int64_t header_ns = 0;
  std::string_view parent, child;
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// A motor's joints, as one message has them; DecodedJoint::position and header_ns are not used.
struct JointStateMessage {
  std::int64_t header_ns = 0;
  std::string_view frame;
  std::vector<DecodedJoint> joints;
  PackedArray<double> positions, velocities, efforts;
};

/// What an IMU measures, in its own frame. A covariance that begins with -1: it is not measured.
struct ImuMessage {
  using Covariance = std::array<double, 9>;
  std::int64_t header_ns = 0;
  std::string_view frame;
  Eigen::Quaterniond orientation{0, 0, 0, 0};
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), acceleration_mps2 = Eigen::Vector3d::Zero();
  Covariance orientation_covariance{}, rate_covariance{}, acceleration_covariance{};
};

/// The pose of the base frame by odometry, in odometry's own fixed frame.
struct OdometryMessage {
  std::int64_t header_ns = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// The bytes of a ScanMessage, CloudMessage, JointStateMessage, ImuMessage, or of a vector of
/// TransformMessage (TFMessage). A header's number, which ROS 1 has, is `sequence`.
template <typename Message>
std::string encode(Encoding encoding, const Message& message, std::uint32_t sequence = 0);

/// Whether a header holds the time: seconds are 32 bits, in ROS 2 with a sign.
bool holds_stamp(Encoding encoding, std::int64_t ns);

/// Empty where the message is malformed.
std::optional<ScanMessage> decode_laser_scan(Encoding encoding, std::span<const std::byte> message);

/// A cloud's fields lie within its points, and its points within its data.
std::optional<CloudMessage> decode_cloud(Encoding encoding, std::span<const std::byte> message);

/// A CustomMsg of livox_ros_driver or livox_ros_driver2, as the cloud with the same numbers; its last point
/// may be shorter than `point_bytes` by what lies behind the last field. The header's stamp is that of the
/// cloud's base time where this counts since 1970: the header's own may then be the publisher's. A base time
/// since the scanner was switched on is on no other clock, and the header's own stamp stands for it.
std::optional<CloudMessage> decode_livox(Encoding encoding, std::span<const std::byte> message);
/// Either of the two, as `kind` says.
inline std::optional<CloudMessage> decode_points(MessageKind kind, Encoding encoding,
                                                 std::span<const std::byte> message) {
  return kind == MessageKind::kLivox ? decode_livox(encoding, message) : decode_cloud(encoding, message);
}

/// Of kJointState and kTransforms. Fills `joints`, whose memory is reused from call to call; false if the
/// message is malformed. Of a transform the joint is the child frame, and its position the angle about `axis`
/// (unit length, in the parent frame), -pi to pi. A joint state without positions has no joints.
bool decode_joints(MessageKind kind, Encoding encoding, std::span<const std::byte> message,
                   const Eigen::Vector3d& axis, std::vector<DecodedJoint>& joints);

/// The part of a rotation (x, y, z and w of its quaternion) that is about an axis of unit length, -pi to pi.
double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& vector, double scalar);

/// Also empty if an IMU reports that it has no gyroscope: -1 as the first covariance of its angular velocity.
std::optional<ImuMessage> decode_imu(Encoding encoding, std::span<const std::byte> message);
std::optional<OdometryMessage> decode_odometry(Encoding encoding, std::span<const std::byte> message);

/// All transforms of a message of transforms, in the same way.
bool decode_transforms(Encoding encoding, std::span<const std::byte> message,
                       std::vector<TransformMessage>& transforms);

}  // namespace sweepscope
