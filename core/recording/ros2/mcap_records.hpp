#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "core/recording/packed/decompress.hpp"

namespace sweepscope {

/// The records of MCAP files (https://mcap.dev/spec): an opcode, a length of 8 bytes, and as much content.
enum class McapOp : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
inline constexpr std::size_t kMcapRecordHeader_bytes = 9;
inline constexpr std::size_t kMcapFooter_bytes = 20;

/// As a chunk names its compression; empty if it names one that MCAP does not have.
std::optional<Compression> mcap_compression(std::string_view name);
/// The reverse. Of a compression that MCAP does not have: "", the name for none.
std::string_view mcap_name(Compression compression);

/// Reads a record's content. After the first error everything is empty and `whole` is false.
class McapFields {
 public:
  explicit McapFields(std::span<const std::byte> content) : rest_(content) {}

  template <typename T>
  T number() {
    T value{};
    if (const auto bytes = take(sizeof(T)); !bytes.empty()) std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  std::string_view text() {
    const auto bytes = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  std::span<const std::byte> rest() const { return rest_; }
  bool whole() const { return whole_; }

 private:
  std::span<const std::byte> take(std::uint64_t bytes) {
    whole_ = whole_ && bytes <= rest_.size();
    const auto taken = whole_ ? rest_.first(bytes) : std::span<const std::byte>();
    rest_ = whole_ ? rest_.subspan(bytes) : std::span<const std::byte>();
    return taken;
  }

  std::span<const std::byte> rest_;
  bool whole_ = true;
};

}  // namespace sweepscope
