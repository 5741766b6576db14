#pragma once

#include <rosbag/bag.h>

#include <cstring>
#include <string>

namespace sweepscope::test {

/// A message of any type for rosbag's writer: what its package defines, and its bytes (MessageBytes, kRos1).
struct WrittenMessage {
  std::string type, md5sum, bytes;
  std::string definition = "";
};

}  // namespace sweepscope::test

namespace ros {

namespace message_traits {
template <>
struct IsMessage<sweepscope::test::WrittenMessage> : TrueType {};
template <>
struct DataType<sweepscope::test::WrittenMessage> {
  static const char* value(const sweepscope::test::WrittenMessage& message) { return message.type.c_str(); }
};
template <>
struct MD5Sum<sweepscope::test::WrittenMessage> {
  static const char* value(const sweepscope::test::WrittenMessage& message) { return message.md5sum.c_str(); }
};
template <>
struct Definition<sweepscope::test::WrittenMessage> {
  static const char* value(const sweepscope::test::WrittenMessage& message) {
    return message.definition.c_str();
  }
};
}  // namespace message_traits

namespace serialization {
template <>
struct Serializer<sweepscope::test::WrittenMessage> {
  template <typename Stream>
  static void write(Stream& stream, const sweepscope::test::WrittenMessage& message) {
    const auto size = serializedLength(message);
    std::memcpy(stream.advance(size), message.bytes.data(), size);
  }
  static std::uint32_t serializedLength(const sweepscope::test::WrittenMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization

}  // namespace ros
