#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/numbers.hpp"
#include "core/recording/messages/messages.hpp"

namespace sweepscope {

/// MessageReader and MessageWriter have the same members, so that one function visits the fields of a message
/// for both: those of messages.cpp.

static_assert(std::endian::native == std::endian::little, "messages are read and written as they lie");

/// A number at any alignment.
template <typename T>
T loaded(const std::byte* bytes, bool swapped) {
  std::array<std::byte, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (swapped) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

/// Calls `visit` with each number of numbers and of ranges of numbers.
template <typename Visit, typename... Fields>
void for_each_number(Visit&& visit, Fields&&... fields) {
  const auto each = [&](auto&& field) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(field)>>)
      visit(field);
    else
      for (auto& number : field) visit(number);
  };
  (each(fields), ...);
}

/// Walks through a message. Once something did not fit, all that follows is empty and `whole` is false.
class MessageReader {
 public:
  MessageReader(Encoding encoding, std::span<const std::byte> message) : cdr_(encoding == Encoding::kCdr) {
    bytes_ = message;
    if (!cdr_) return;
    // The representation's identifier, big-endian: 0 or 1 for plain CDR; and two bytes of options.
    whole_ = message.size() >= 4 && message[0] == std::byte{0} && message[1] <= std::byte{1};
    if (!whole_) return;
    swapped_ = message[1] == std::byte{0};
    bytes_ = message.subspan(4);
  }

  template <typename... Fields>
  void numbers(Fields&&... fields) {
    for_each_number([&](auto& value) { value = number<std::remove_reference_t<decltype(value)>>(); },
                    fields...);
  }
  void flag(bool& value) { value = number<std::uint8_t>() != 0; }
  void text(std::string_view& text) {
    const auto bytes = take(number<std::uint32_t>());
    text = {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    if (cdr_ && text.ends_with('\0')) text.remove_suffix(1);
  }
  template <typename T>
  void array(PackedArray<T>& array) {
    const std::uint64_t count = number<std::uint32_t>();
    if (count > 0) align(sizeof(T));
    array = {take(count * sizeof(T)), swapped_};
  }
  void bytes(std::span<const std::byte>& bytes) { bytes = take(number<std::uint32_t>()); }
  /// An array of messages, each of which `visit` reads; malformed if there are more than `max_count`.
  template <typename List, typename Visit>
  void list(List& list, Visit visit, std::uint32_t max_count = UINT32_MAX) {
    const auto count = number<std::uint32_t>();
    whole_ = whole_ && count <= max_count;
    for (std::uint32_t i = 0; i < count && whole_; ++i) visit(*this, list.emplace_back());
  }
  /// std_msgs/Header: in ROS 1 a number; the stamp, the frame's name. 0: no stamp.
  void header(std::int64_t& ns, std::string_view& frame) {
    if (!cdr_) number<std::uint32_t>();
    // ROS 2's seconds are signed; before 1970 there is no stamp.
    const auto seconds = number<std::uint32_t>();
    ns = seconds * kSecond_ns + number<std::uint32_t>();
    if (cdr_ && static_cast<std::int32_t>(seconds) < 0) ns = 0;
    text(frame);
  }
  /// An array of so many bytes each; in CDR their first number is aligned to 4, and none lie behind the last.
  std::span<const std::byte> records(std::uint32_t count, std::uint32_t record_bytes) {
    constexpr std::uint32_t kAligned_bytes = 4;
    if (count == 0) return {};
    align(kAligned_bytes);
    const std::uint64_t bytes = record_bytes;
    const std::uint64_t step = cdr_ ? (bytes + kAligned_bytes - 1) / kAligned_bytes * kAligned_bytes : bytes;
    return take(step * (count - 1) + record_bytes);
  }
  /// Passes over so many numbers of so many bytes.
  void skip(std::size_t number_bytes, std::uint64_t count) {
    if (count > 0) align(number_bytes);
    take(number_bytes * count);
  }
  /// The position, for since().
  std::size_t at() const { return at_; }
  /// What was passed since then, of a message that begins with a header: from its first number on.
  std::span<const std::byte> since(std::size_t begin) const {
    constexpr std::size_t kAligned_bytes = 4;
    if (cdr_) begin = (begin + kAligned_bytes - 1) / kAligned_bytes * kAligned_bytes;
    return whole_ && begin <= at_ ? bytes_.subspan(begin, at_ - begin) : std::span<const std::byte>();
  }
  bool whole() const { return whole_; }
  bool swapped() const { return swapped_; }
  /// Middlewares fill a message of CDR up to a multiple of four bytes.
  bool at_end() const { return whole_ && bytes_.size() - at_ <= (cdr_ ? 3 : 0); }

 private:
  template <typename T>
  T number() {
    align(sizeof(T));
    const auto bytes = take(sizeof(T));
    return bytes.empty() ? T{} : loaded<T>(bytes.data(), swapped_);
  }
  void align(std::size_t size) {
    if (cdr_) take((size - at_ % size) % size);
  }
  std::span<const std::byte> take(std::uint64_t count) {
    if (!whole_ || count > bytes_.size() - at_) {
      whole_ = false;
      return {};
    }
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool cdr_, swapped_ = false, whole_ = true;
};

/// Serialises a message; CDR is little-endian. A header's number, which ROS 1 has, is `sequence`.
class MessageWriter {
 public:
  explicit MessageWriter(Encoding encoding, std::uint32_t sequence = 0)
      : cdr_(encoding == Encoding::kCdr), sequence_(sequence) {
    if (cdr_) bytes_.append({'\0', '\1', '\0', '\0'});  // the representation identifier
  }

  template <typename... Fields>
  void numbers(const Fields&... fields) {
    for_each_number([&](const auto& value) { number(value); }, fields...);
  }
  void flag(bool value) { number(static_cast<std::uint8_t>(value)); }
  void text(std::string_view text) {
    count(text.size() + (cdr_ ? 1 : 0));
    bytes_.append(text);
    if (cdr_) bytes_ += '\0';
  }
  template <typename T>
  void array(const PackedArray<T>& array) {
    count(array.size());
    if (array.size() > 0) align(sizeof(T));
    if (array.swapped)
      for (std::size_t i = 0; i < array.size(); ++i) number(array[i]);
    else
      append(array.bytes);
  }
  void bytes(std::span<const std::byte> bytes) {
    count(bytes.size());
    append(bytes);
  }
  template <typename List, typename Visit>
  void list(const List& list, Visit visit, std::uint32_t = UINT32_MAX) {
    count(list.size());
    for (const auto& element : list) visit(*this, element);
  }
  void header(std::int64_t ns, std::string_view frame) {
    if (!cdr_) number(sequence_);
    number(static_cast<std::uint32_t>(ns / kSecond_ns));
    number(static_cast<std::uint32_t>(ns % kSecond_ns));
    text(frame);
  }
  std::string take() { return std::move(bytes_); }

 private:
  template <typename T>
  void number(T value) {
    align(sizeof(T));
    append(std::as_bytes(std::span(&value, 1)));
  }
  void count(std::size_t count) { number(static_cast<std::uint32_t>(count)); }
  void align(std::size_t size) {
    constexpr std::size_t kStart = 4;  // CDR's alignment counts from after the identifier
    if (cdr_) bytes_.resize(bytes_.size() + (size - (bytes_.size() - kStart) % size) % size);
  }
  void append(std::span<const std::byte> bytes) {
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }

  bool cdr_;
  std::uint32_t sequence_;
  std::string bytes_;
};

}  // namespace sweepscope
