#include "core/apply/stamp_shift.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <vector>

#include "core/numbers.hpp"
#include "core/recording/messages/message_archives.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kStamp_bytes = 8;  // seconds and nanoseconds

void store(std::byte* at, std::uint32_t value, bool swapped) {
  auto bytes = std::bit_cast<std::array<std::byte, 4>>(value);
  if (swapped) std::ranges::reverse(bytes);
  std::memcpy(at, bytes.data(), bytes.size());
}

std::int64_t stamp_at(const std::byte* at, bool swapped) {
  return loaded<std::uint32_t>(at, swapped) * kSecond_ns + loaded<std::uint32_t>(at + 4, swapped);
}

StampShift shift_stamp(std::byte* at, Encoding encoding, bool swapped, const StampMap& moved) {
  const std::int64_t before_ns = stamp_at(at, swapped);
  if (before_ns == 0) return StampShift::kNone;
  const std::int64_t after_ns = moved(before_ns);
  if (after_ns == 0 || !holds_stamp(encoding, after_ns)) return StampShift::kOutOfRange;
  store(at, static_cast<std::uint32_t>(after_ns / kSecond_ns), swapped);
  store(at + 4, static_cast<std::uint32_t>(after_ns % kSecond_ns), swapped);
  return StampShift::kShifted;
}

/// The byte positions of the stamps. No value if the message is malformed.
std::optional<std::vector<std::size_t>> stamp_places(MessageKind kind, Encoding encoding,
                                                     const std::string& joint,
                                                     std::span<const std::byte> message) {
  constexpr std::size_t kFrameLength_bytes = 4;
  std::vector<std::size_t> places;
  if (kind == MessageKind::kTransforms) {
    std::vector<TransformMessage> transforms;
    if (!decode_transforms(encoding, message, transforms)) return std::nullopt;
    for (const TransformMessage& transform : transforms) {
      if (transform.child != joint) continue;
      // Layout: stamp, length of the parent's name, the name.
      const auto* const name = reinterpret_cast<const std::byte*>(transform.parent.data());
      places.push_back(static_cast<std::size_t>(name - message.data()) - kFrameLength_bytes - kStamp_bytes);
    }
    return places;
  }
  if (kind == MessageKind::kFieldsWithoutHeader) return places;
  // ROS 1: the sequence number. CDR: the representation identifier.
  constexpr std::size_t kBefore_bytes = 4;
  if (message.size() < kBefore_bytes + kStamp_bytes) return std::nullopt;
  const bool plain_cdr = message[0] == std::byte{0} && message[1] <= std::byte{1};
  if (encoding == Encoding::kCdr && !plain_cdr) return std::nullopt;
  places.push_back(kBefore_bytes);
  return places;
}

}  // namespace

StampShift shift_header_stamps(MessageKind kind, Encoding encoding, const std::string& joint,
                               const StampMap& moved, std::span<std::byte> message) {
  const auto places = stamp_places(kind, encoding, joint, message);
  if (!places) return StampShift::kMalformed;
  const bool swapped = encoding == Encoding::kCdr && message[1] == std::byte{0};
  StampShift all = StampShift::kNone;
  for (const std::size_t place : *places) {
    const StampShift one = shift_stamp(message.data() + place, encoding, swapped, moved);
    if (one == StampShift::kOutOfRange) return one;
    if (one == StampShift::kShifted) all = one;
  }
  return all;
}

std::optional<std::int64_t> header_stamp_ns(MessageKind kind, Encoding encoding,
                                            std::span<const std::byte> message) {
  const auto places = stamp_places(kind, encoding, "", message);
  if (!places || places->size() != 1) return std::nullopt;
  const bool swapped = encoding == Encoding::kCdr && message[1] == std::byte{0};
  const std::int64_t stamp_ns = stamp_at(message.data() + places->front(), swapped);
  return stamp_ns == 0 ? std::nullopt : std::optional(stamp_ns);
}

}  // namespace sweepscope
