#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/numbers.hpp"
#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// Serialises a message member by member: as ROS 1 does, or as ROS 2's plain CDR (XCDR1), little-endian.
class MessageWriter {
 public:
  explicit MessageWriter(Encoding encoding) : cdr_(encoding == Encoding::kCdr) {
    if (cdr_) bytes_.append({'\0', '\1', '\0', '\0'});  // the representation identifier
  }

  template <typename T>
  void number(T value) {
    if (cdr_) bytes_.resize(bytes_.size() + (sizeof(T) - (bytes_.size() - kStart) % sizeof(T)) % sizeof(T));
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size() + (cdr_ ? 1 : 0)));
    bytes_.append(text);
    if (cdr_) bytes_ += '\0';
  }
  void array(std::span<const std::byte> bytes) {
    number(static_cast<std::uint32_t>(bytes.size()));
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  template <typename T>
  void array(std::span<const T> numbers) {
    number(static_cast<std::uint32_t>(numbers.size()));
    for (const T value : numbers) number(value);
  }
  /// std_msgs/Header; ROS 1's has a number, which is left 0.
  void header(std::int64_t ns, std::string_view frame) {
    if (!cdr_) number(std::uint32_t{0});
    number(static_cast<std::int32_t>(ns / kSecond_ns));
    number(static_cast<std::uint32_t>(ns % kSecond_ns));
    text(frame);
  }
  std::string take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kStart = 4;  // CDR's alignment counts from after the identifier
  bool cdr_;
  std::string bytes_;
};

}  // namespace sweepscope
