#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

namespace sweepscope {

/// What a bag of format 2.0 begins with.
inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

/// The kind of a record of a ROS 1 bag, its field "op".
enum class BagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/// A little-endian number at the front of `bytes`, which must hold it.
template <typename T>
T load(std::span<const std::byte> bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The header of a record: fields "name=value", each with its length before it.
class BagFields {
 public:
  /// Empty if the bytes are not exactly such fields.
  static std::optional<BagFields> parse(std::span<const std::byte> bytes);

  std::optional<std::span<const std::byte>> find(std::string_view name) const;
  std::optional<std::string_view> text(std::string_view name) const;
  /// Empty if there is no such field, or it has another size.
  template <typename T>
  std::optional<T> number(std::string_view name) const {
    const auto value = find(name);
    if (!value || value->size() != sizeof(T)) return std::nullopt;
    return load<T>(*value);
  }
  /// The field "time": seconds and nanoseconds.
  std::optional<std::int64_t> time_ns() const;
  std::optional<BagOp> op() const;

 private:
  explicit BagFields(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::span<const std::byte> bytes_;
};

/// A record within bytes in memory.
struct BagRecord {
  BagFields fields;
  std::span<const std::byte> data;
  std::size_t length;  // of the whole record
};

/// The record at the front of `bytes`; empty if they do not hold a complete one.
std::optional<BagRecord> parse_record(std::span<const std::byte> bytes);

}  // namespace sweepscope
