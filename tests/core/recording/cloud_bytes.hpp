#pragma once

#include <cstdint>
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

}  // namespace sweepscope::test
