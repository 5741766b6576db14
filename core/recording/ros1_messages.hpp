#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace sweepscope {

/// The two messages that an actuated scanner is recorded with, as ROS 1 serialises them. Each decoder is
/// bounded: a length that the message does not hold, or bytes left over, make it malformed, and nothing is
/// allocated for it. What they give points into the message's bytes.

inline constexpr std::string_view kLaserScanType = "sensor_msgs/LaserScan";
inline constexpr std::string_view kLaserScanMd5 = "90c7ef2dc6895d81024acba2ac42f369";
inline constexpr std::string_view kJointStateType = "sensor_msgs/JointState";
inline constexpr std::string_view kJointStateMd5 = "3066dcd76a6cfaef579bd0f34173e9fd";

/// Little-endian numbers in a message, at any alignment.
template <typename T>
struct PackedArray {
  std::span<const std::byte> bytes;

  std::size_t size() const { return bytes.size() / sizeof(T); }
  T operator[](std::size_t i) const;
  void append_to(std::vector<T>& numbers) const;
};

struct Ros1LaserScan {
  std::int64_t header_ns = 0;
  float angle_min_rad = 0, angle_max_rad = 0, angle_increment_rad = 0;
  float time_increment_s = 0, scan_time_s = 0;
  float range_min_m = 0, range_max_m = 0;
  PackedArray<float> ranges_m, intensities;
};

struct Ros1JointState {
  std::int64_t header_ns = 0;
  std::vector<std::string_view> names;
  PackedArray<double> positions;  // one per name, or none at all
};

/// Empty where the message is malformed.
std::optional<Ros1LaserScan> decode_laser_scan(std::span<const std::byte> message);
/// Fills `state`, whose memory is used again from call to call; false where the message is malformed.
bool decode_joint_state(std::span<const std::byte> message, Ros1JointState& state);

}  // namespace sweepscope
