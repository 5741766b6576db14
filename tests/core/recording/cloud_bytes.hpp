#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/core/recording/message_bytes.hpp"

namespace sweepscope::test {

/// The types of a cloud's numbers, as sensor_msgs/PointField numbers them.
enum class CloudType : std::uint8_t { kUint8 = 2, kUint16 = 4, kUint32 = 6, kFloat32 = 7, kFloat64 = 8 };

/// A sensor_msgs/PointCloud2 being written point by point: x, y, z, a time of any name and type, and a ring.
class CloudBytes {
 public:
  CloudBytes(std::string time_name, CloudType time_type, bool rings)
      : time_name_(std::move(time_name)), time_type_(time_type), rings_(rings) {}

  CloudBytes& point(float x, float y, float z, double time, std::uint16_t ring = 0) {
    for (const float part : {x, y, z}) put(part);
    if (rings_) put(ring);
    if (time_type_ == CloudType::kFloat64) put(time);
    if (time_type_ == CloudType::kFloat32) put(static_cast<float>(time));
    if (time_type_ == CloudType::kUint32) put(static_cast<std::uint32_t>(time));
    ++points_;
    return *this;
  }
  std::uint32_t point_bytes() const {
    return 12 + (rings_ ? 2U : 0U) + (time_type_ == CloudType::kFloat64 ? 8U : 4U);
  }
  std::string message(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds) const {
    MessageBytes message(form);
    message.header(seconds, nanoseconds, "lidar").number(std::uint32_t{1}).number(points_);
    message.number(std::uint32_t{rings_ ? 5U : 4U});
    std::uint32_t offset = 0;
    for (const char* name : {"x", "y", "z"}) {
      field(message, name, offset, CloudType::kFloat32);
      offset += 4;
    }
    if (rings_) {
      field(message, "ring", offset, CloudType::kUint16);
      offset += 2;
    }
    field(message, time_name_, offset, time_type_);
    message.number(std::uint8_t{0}).number(point_bytes()).number(points_ * point_bytes());
    message.number(static_cast<std::uint32_t>(data_.size()));
    return message.bytes() + data_ + '\1';
  }

 private:
  template <typename T>
  void put(T value) {
    data_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  static void field(MessageBytes& message, const std::string& name, std::uint32_t offset, CloudType type) {
    message.text(name).number(offset).number(static_cast<std::uint8_t>(type)).number(std::uint32_t{1});
  }

  std::string time_name_;
  CloudType time_type_;
  bool rings_;
  std::uint32_t points_ = 0;
  std::string data_;
};

/// A CustomMsg of livox_ros_driver or livox_ros_driver2 being written point by point, as their definitions
/// order its members.
class LivoxBytes {
 public:
  struct Point {
    float x = 0, y = 0, z = 0;
    std::uint32_t offset_ns = 0;
    std::uint8_t line = 0, tag = 0, reflectivity = 40;
  };

  LivoxBytes& point(const Point& point) {
    points_.push_back(point);
    return *this;
  }
  /// `base_ns`: the time that the points' count from. `count`: as the array says, where that is not its
  /// length.
  std::string message(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds,
                      std::uint64_t base_ns, std::optional<std::uint32_t> count = std::nullopt) const {
    MessageBytes message(form);
    const auto size = static_cast<std::uint32_t>(points_.size());
    message.header(seconds, nanoseconds, "livox_frame").number(base_ns).number(size);
    message.number(std::uint8_t{1}).fill(3);  // lidar_id, and three that are reserved
    message.number(count.value_or(size));
    for (const Point& point : points_) {
      message.number(point.offset_ns).number(point.x).number(point.y).number(point.z);
      message.number(point.reflectivity).number(point.tag).number(point.line);
    }
    return message.bytes();
  }

 private:
  std::vector<Point> points_;
};

}  // namespace sweepscope::test
