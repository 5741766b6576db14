#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/recording/ros2/mcap_records.hpp"

namespace sweepscope {

/// The content of a record, little-endian.
class McapContent {
 public:
  template <typename T>
  McapContent& number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  McapContent& text(std::string_view text) {
    return number(static_cast<std::uint32_t>(text.size())).raw(text);
  }
  McapContent& raw(std::string_view bytes) {
    bytes_.append(bytes);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

inline std::string mcap_record(McapOp op, const McapContent& content) {
  std::string bytes(1, static_cast<char>(op));
  const std::uint64_t length = content.bytes().size();
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  return bytes + content.bytes();
}

}  // namespace sweepscope
