#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace sweepscope::test {

/// Serialises a message field by field, as its specification says, independently of the program's own
/// writers.
class MessageBytes {
 public:
  enum Form { kRos1, kCdr, kCdrBigEndian };
  explicit MessageBytes(Form form) : form_(form) {
    if (form == kCdr) bytes_ = std::string("\0\1\0\0", 4);
    if (form == kCdrBigEndian) bytes_ = std::string("\0\0\0\0", 4);
  }

  template <typename T>
  MessageBytes& number(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (form_ != kRos1)
      while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '\0';
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_ += raw[form_ == kCdrBigEndian ? sizeof(T) - 1 - i : i];
    return *this;
  }
  MessageBytes& text(const std::string& text) {
    number(static_cast<std::uint32_t>(text.size() + (form_ == kRos1 ? 0 : 1)));
    bytes_ += text;
    if (form_ != kRos1) bytes_ += '\0';
    return *this;
  }
  template <typename T>
  MessageBytes& array(const std::vector<T>& numbers) {
    number(static_cast<std::uint32_t>(numbers.size()));
    for (const T value : numbers) number(value);
    return *this;
  }
  MessageBytes& header(std::uint32_t seconds, std::uint32_t nanoseconds, const std::string& frame) {
    if (form_ == kRos1) number(std::uint32_t{7});
    return number(seconds).number(nanoseconds).text(frame);
  }
  MessageBytes& fill(std::size_t bytes) {
    bytes_.append(bytes, '\0');
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Form form_;
  std::string bytes_;
};

inline std::span<const std::byte> as_span(const std::string& bytes) {
  return std::as_bytes(std::span(bytes.data(), bytes.size()));
}

inline std::string scan_bytes(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds,
                              const std::vector<float>& ranges, const std::vector<float>& intensities = {}) {
  MessageBytes message(form);
  message.header(seconds, nanoseconds, "laser");
  for (const float value : {-0.5F, 0.5F, 0.25F, 0.001F, 0.025F, 0.1F, 30.0F}) message.number(value);
  return message.array(ranges).array(intensities).bytes();
}

inline std::string joint_bytes(MessageBytes::Form form, std::uint32_t seconds, std::uint32_t nanoseconds,
                               const std::vector<std::string>& names, const std::vector<double>& positions) {
  MessageBytes message(form);
  message.header(seconds, nanoseconds, "").number(static_cast<std::uint32_t>(names.size()));
  for (const std::string& name : names) message.text(name);
  return message.array(positions).array(std::vector<double>()).array(std::vector<double>()).bytes();
}

}  // namespace sweepscope::test
