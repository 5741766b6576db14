#include "core/recording/ros1_messages.hpp"

#include <cstring>

namespace sweepscope {
namespace {

/// Walks through a message. Once something did not fit, all that follows is empty and `whole` is false.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : left_(bytes) {}

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
  template <typename T>
  PackedArray<T> array() {
    return {take(std::uint64_t{number<std::uint32_t>()} * sizeof(T))};
  }
  /// std_msgs/Header: a number, the stamp, the frame's name.
  std::int64_t header_ns() {
    number<std::uint32_t>();
    const std::int64_t seconds = number<std::uint32_t>();
    const std::int64_t nanoseconds = number<std::uint32_t>();
    text();
    return seconds * 1'000'000'000 + nanoseconds;
  }
  bool whole() const { return whole_; }
  bool at_end() const { return whole_ && left_.empty(); }

 private:
  std::span<const std::byte> take(std::uint64_t bytes) {
    if (bytes > left_.size()) {
      whole_ = false;
      left_ = {};
      return {};
    }
    const auto taken = left_.first(bytes);
    left_ = left_.subspan(bytes);
    return taken;
  }

  std::span<const std::byte> left_;
  bool whole_ = true;
};

}  // namespace

template <typename T>
T PackedArray<T>::operator[](std::size_t i) const {
  T value;
  std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
  return value;
}

template <typename T>
void PackedArray<T>::append_to(std::vector<T>& numbers) const {
  const std::size_t before = numbers.size();
  numbers.resize(before + size());
  if (!bytes.empty()) std::memcpy(numbers.data() + before, bytes.data(), bytes.size());
}

template struct PackedArray<float>;
template struct PackedArray<double>;

std::optional<Ros1LaserScan> decode_laser_scan(std::span<const std::byte> message) {
  Cursor cursor(message);
  Ros1LaserScan scan;
  scan.header_ns = cursor.header_ns();
  for (float* value : {&scan.angle_min_rad, &scan.angle_max_rad, &scan.angle_increment_rad,
                       &scan.time_increment_s, &scan.scan_time_s, &scan.range_min_m, &scan.range_max_m}) {
    *value = cursor.number<float>();
  }
  scan.ranges_m = cursor.array<float>();
  scan.intensities = cursor.array<float>();
  if (!cursor.at_end()) return std::nullopt;
  return scan;
}

bool decode_joint_state(std::span<const std::byte> message, Ros1JointState& state) {
  Cursor cursor(message);
  state.header_ns = cursor.header_ns();
  state.names.clear();
  const auto names = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < names && cursor.whole(); ++i) state.names.push_back(cursor.text());
  state.positions = cursor.array<double>();
  cursor.array<double>();  // velocity, which drivers leave at 0 or get wrong
  cursor.array<double>();  // effort
  return cursor.at_end() && (state.positions.size() == state.names.size() || state.positions.size() == 0);
}

}  // namespace sweepscope
