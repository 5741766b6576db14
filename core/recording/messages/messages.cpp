#include "core/recording/messages/messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {

static_assert(std::endian::native == std::endian::little, "messages are read as they lie");

namespace {

constexpr MessageType kTypes[] = {
    {"sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369", MessageKind::kLaserScan},
    {"sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181", MessageKind::kCloud},
    {"livox_ros_driver/CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6", MessageKind::kLivox},
    {"livox_ros_driver2/CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6", MessageKind::kLivox},
    {"sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd", MessageKind::kJointState},
    {"dynamixel_msgs/JointState", "2b8449320cde76616338e2539db27c32", MessageKind::kDynamixel},
    {"std_msgs/Float64", "fdb28210bfa9d7c91146260178d9a584", MessageKind::kFloat64},
    {"std_msgs/Float32", "73fcbf46b49191e672908e50842a83d4", MessageKind::kFloat32},
    {"std_msgs/Int32", "da5909fbe378aeaf85e547e830cc1bb7", MessageKind::kInt32},
    {"tf/tfMessage", "94810edda583a504dfda3829e70d7eec", MessageKind::kTransforms},
    {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec", MessageKind::kTransforms},
    {"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2", MessageKind::kImu},
    {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7", MessageKind::kOdometry},
};

constexpr std::string_view kOnlyJoint = "data";

template <typename T>
T loaded(const std::byte* bytes, bool swapped) {
  std::array<std::byte, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (swapped) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

/// Walks through a message. Once something did not fit, all that follows is empty and `whole` is false.
class Cursor {
 public:
  Cursor(Encoding encoding, std::span<const std::byte> message) : cdr_(encoding == Encoding::kCdr) {
    bytes_ = message;
    if (!cdr_) return;
    // The representation's identifier, big-endian: 0 or 1 for plain CDR; and two bytes of options.
    whole_ = message.size() >= 4 && message[0] == std::byte{0} && message[1] <= std::byte{1};
    if (!whole_) return;
    swapped_ = message[1] == std::byte{0};
    bytes_ = message.subspan(4);
  }

  template <typename T>
  T number() {
    align(sizeof(T));
    const auto bytes = take(sizeof(T));
    return bytes.empty() ? T{} : loaded<T>(bytes.data(), swapped_);
  }
  /// Passes over so many doubles.
  void numbers(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) number<double>();
  }
  std::string_view text() {
    const auto bytes = take(number<std::uint32_t>());
    std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    if (cdr_ && text.ends_with('\0')) text.remove_suffix(1);
    return text;
  }
  template <typename T>
  PackedArray<T> array() {
    const std::uint64_t count = number<std::uint32_t>();
    if (count > 0) align(sizeof(T));
    return {take(count * sizeof(T)), swapped_};
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
  bool swapped() const { return swapped_; }
  /// std_msgs/Header: in ROS 1 a number; the stamp, the frame's name.
  std::int64_t header_ns(std::string_view* frame = nullptr) {
    if (!cdr_) number<std::uint32_t>();
    // ROS 2's seconds are signed; before 1970 there is no stamp.
    const auto seconds = number<std::uint32_t>();
    const std::int64_t nanoseconds = number<std::uint32_t>();
    const std::string_view name = text();
    if (frame != nullptr) *frame = name;
    if (cdr_ && static_cast<std::int32_t>(seconds) < 0) return 0;
    return seconds * kSecond_ns + nanoseconds;
  }
  bool whole() const { return whole_; }
  /// Middlewares fill a message of CDR up to a multiple of four bytes.
  bool at_end() const { return whole_ && bytes_.size() - at_ <= (cdr_ ? 3 : 0); }

 private:
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

bool decode_joint_state(Cursor& cursor, std::vector<DecodedJoint>& joints) {
  const std::int64_t header_ns = cursor.header_ns();
  const auto names = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < names && cursor.whole(); ++i) joints.push_back({header_ns, cursor.text(), 0});
  const auto positions = cursor.array<double>();
  cursor.array<double>();  // velocity, which drivers leave at 0 or get wrong
  cursor.array<double>();  // effort
  if (positions.size() == 0) joints.clear();
  if (!cursor.at_end() || positions.size() != joints.size()) return false;
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].position = positions[i];
  return true;
}

bool decode_dynamixel(Cursor& cursor, std::vector<DecodedJoint>& joints) {
  DecodedJoint joint;
  joint.header_ns = cursor.header_ns();
  joint.name = cursor.text();
  cursor.array<std::int32_t>();  // motor_ids
  cursor.array<std::int32_t>();  // motor_temps
  cursor.number<double>();       // goal_pos
  joint.position = cursor.number<double>();
  for (int i = 0; i < 3; ++i) cursor.number<double>();  // error, velocity, load
  cursor.number<std::uint8_t>();                        // is_moving
  joints.push_back(joint);
  return cursor.at_end();
}

template <typename T>
bool decode_number(Cursor& cursor, std::vector<DecodedJoint>& joints) {
  joints.push_back({0, kOnlyJoint, static_cast<double>(cursor.number<T>())});
  return cursor.at_end();
}

/// The part of a rotation that is about an axis (the twist of its swing-twist decomposition).
double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& vector, double scalar) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return std::remainder(2 * std::atan2(axis.dot(vector), scalar), kTurn);
}

DecodedTransform decode_transform(Cursor& cursor) {
  DecodedTransform transform;
  transform.header_ns = cursor.header_ns(&transform.parent);
  transform.child = cursor.text();
  for (double& part : transform.translation_m) part = cursor.number<double>();
  for (double& part : transform.rotation.coeffs()) part = cursor.number<double>();  // x, y, z, w
  return transform;
}

bool decode_turned_frames(Cursor& cursor, const Eigen::Vector3d& axis, std::vector<DecodedJoint>& joints) {
  const auto transforms = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < transforms && cursor.whole(); ++i) {
    const DecodedTransform frame = decode_transform(cursor);
    joints.push_back(
        {frame.header_ns, frame.child, angle_about(axis, frame.rotation.vec(), frame.rotation.w())});
  }
  return cursor.at_end();
}

}  // namespace

const MessageType* find_message_type(std::string_view name) {
  const auto same = [&](const MessageType& type) {
    if (type.name == name) return true;
    const std::size_t slash = type.name.find('/');
    return name.size() == type.name.size() + 4 && name.starts_with(type.name.substr(0, slash)) &&
           name.substr(slash, 4) == "/msg" && name.ends_with(type.name.substr(slash));
  };
  const auto* const found = std::ranges::find_if(kTypes, same);
  return found == std::end(kTypes) ? nullptr : found;
}

template <typename T>
T PackedArray<T>::operator[](std::size_t i) const {
  return loaded<T>(bytes.data() + i * sizeof(T), swapped);
}

template <typename T>
void PackedArray<T>::append_to(std::vector<T>& numbers) const {
  const std::size_t before = numbers.size();
  numbers.resize(before + size());
  if (!bytes.empty()) std::memcpy(numbers.data() + before, bytes.data(), size() * sizeof(T));
  if (!swapped) return;
  for (std::size_t i = 0; i < size(); ++i) numbers[before + i] = (*this)[i];
}

template struct PackedArray<float>;
template struct PackedArray<double>;

std::optional<DecodedScan> decode_laser_scan(Encoding encoding, std::span<const std::byte> message) {
  Cursor cursor(encoding, message);
  DecodedScan scan;
  scan.header_ns = cursor.header_ns(&scan.frame);
  for (float* value : {&scan.angle_min_rad, &scan.angle_max_rad, &scan.angle_increment_rad,
                       &scan.time_increment_s, &scan.scan_time_s, &scan.range_min_m, &scan.range_max_m}) {
    *value = cursor.number<float>();
  }
  scan.ranges_m = cursor.array<float>();
  scan.intensities = cursor.array<float>();
  if (!cursor.at_end()) return std::nullopt;
  return scan;
}

std::size_t CloudField::size() const {
  constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};  // int8, uint8, int16, ... float32, float64
  return datatype < std::size(kSizes) ? kSizes[datatype] : 0;
}

double DecodedCloud::value(std::size_t point, const CloudField& field) const {
  const std::byte* bytes =
      data.data() + point / width * row_bytes + point % width * point_bytes + field.offset;
  switch (field.datatype) {
    case 1:
      return loaded<std::int8_t>(bytes, false);
    case 2:
      return loaded<std::uint8_t>(bytes, false);
    case 3:
      return loaded<std::int16_t>(bytes, swapped);
    case 4:
      return loaded<std::uint16_t>(bytes, swapped);
    case 5:
      return loaded<std::int32_t>(bytes, swapped);
    case 6:
      return loaded<std::uint32_t>(bytes, swapped);
    case 7:
      return double{loaded<float>(bytes, swapped)};
    default:
      return loaded<double>(bytes, swapped);
  }
}

std::optional<DecodedCloud> decode_cloud(Encoding encoding, std::span<const std::byte> message) {
  constexpr std::uint32_t kMaxFields = 256;
  Cursor cursor(encoding, message);
  DecodedCloud cloud;
  cloud.header_ns = cursor.header_ns(&cloud.frame);
  cloud.height = cursor.number<std::uint32_t>();
  cloud.width = cursor.number<std::uint32_t>();
  const auto fields = cursor.number<std::uint32_t>();
  if (fields > kMaxFields) return std::nullopt;
  for (std::uint32_t i = 0; i < fields && cursor.whole(); ++i) {
    CloudField& field = cloud.fields.emplace_back();
    field.name = cursor.text();
    field.offset = cursor.number<std::uint32_t>();
    field.datatype = cursor.number<std::uint8_t>();
    field.count = cursor.number<std::uint32_t>();
  }
  cloud.swapped = cursor.number<std::uint8_t>() != 0;
  cloud.point_bytes = cursor.number<std::uint32_t>();
  cloud.row_bytes = cursor.number<std::uint32_t>();
  cloud.data = cursor.array<std::byte>().bytes;
  cloud.dense = cursor.number<std::uint8_t>() != 0;
  if (!cursor.at_end()) return std::nullopt;
  if (cloud.points() == 0) return cloud;
  for (const CloudField& field : cloud.fields)
    if (std::uint64_t{field.offset} + field.size() > cloud.point_bytes) return std::nullopt;
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_bytes;
  if (cloud.point_bytes == 0 || row > cloud.data.size()) return std::nullopt;
  // Rows that overlap would be more points than there are bytes. Of one row drivers leave the step at 0.
  if (cloud.height > 1 && cloud.row_bytes < row) return std::nullopt;
  if (std::uint64_t{cloud.row_bytes} * (cloud.height - 1) > cloud.data.size() - row) return std::nullopt;
  return cloud;
}

std::optional<DecodedCloud> decode_livox(Encoding encoding, std::span<const std::byte> message) {
  constexpr std::uint32_t kPoint_bytes = 19, kPointInCdr_bytes = 20;
  constexpr std::uint64_t kSince1970_ns = 100'000'000'000'000'000, kLatest_ns = std::uint64_t{1} << 62;
  constexpr std::uint8_t kUint8 = 2, kUint32 = 6, kFloat32 = 7;
  Cursor cursor(encoding, message);
  DecodedCloud cloud;
  cloud.header_ns = cursor.header_ns(&cloud.frame);
  const auto base_ns = cursor.number<std::uint64_t>();
  cursor.number<std::uint32_t>();                                 // point_num: the array says it too
  for (int i = 0; i < 1 + 3; ++i) cursor.number<std::uint8_t>();  // lidar_id, and three that are reserved
  cloud.height = 1;
  cloud.width = cursor.number<std::uint32_t>();
  cloud.point_bytes = encoding == Encoding::kCdr ? kPointInCdr_bytes : kPoint_bytes;
  cloud.row_bytes = cloud.width * cloud.point_bytes;
  cloud.data = cursor.records(cloud.width, kPoint_bytes);
  cloud.swapped = cursor.swapped();
  if (!cursor.at_end() || cloud.data.size() > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  cloud.fields = {{"offset_time", 0, kUint32},  {"x", 4, kFloat32},  {"y", 8, kFloat32},  {"z", 12, kFloat32},
                  {"reflectivity", 16, kUint8}, {"tag", 17, kUint8}, {"line", 18, kUint8}};
  cloud.time_unit_s = 1e-9;
  cloud.has_time_base = base_ns > kSince1970_ns && base_ns < kLatest_ns;
  if (cloud.has_time_base) cloud.header_ns = static_cast<std::int64_t>(base_ns);
  return cloud;
}

bool decode_joints(MessageKind kind, Encoding encoding, std::span<const std::byte> message,
                   const Eigen::Vector3d& axis, std::vector<DecodedJoint>& joints) {
  joints.clear();
  Cursor cursor(encoding, message);
  switch (kind) {
    case MessageKind::kJointState:
      return decode_joint_state(cursor, joints);
    case MessageKind::kDynamixel:
      return decode_dynamixel(cursor, joints);
    case MessageKind::kFloat64:
      return decode_number<double>(cursor, joints);
    case MessageKind::kFloat32:
      return decode_number<float>(cursor, joints);
    case MessageKind::kInt32:
      return decode_number<std::int32_t>(cursor, joints);
    case MessageKind::kTransforms:
      return decode_turned_frames(cursor, axis, joints);
    case MessageKind::kLaserScan:
    case MessageKind::kCloud:
    case MessageKind::kLivox:
    case MessageKind::kImu:
    case MessageKind::kOdometry:
      break;
  }
  return false;
}

std::optional<DecodedTurnRate> decode_imu(Encoding encoding, std::span<const std::byte> message) {
  Cursor cursor(encoding, message);
  DecodedTurnRate imu;
  imu.header_ns = cursor.header_ns();
  cursor.numbers(4 + 9);  // orientation and its covariance
  for (double& part : imu.rate_rad_s) part = cursor.number<double>();
  const auto rate_variance = cursor.number<double>();
  cursor.numbers(8 + 3 + 9);  // the other covariances of the rate; acceleration and its covariance
  if (!cursor.at_end() || rate_variance == -1) return std::nullopt;
  return imu;
}

std::optional<DecodedOdometry> decode_odometry(Encoding encoding, std::span<const std::byte> message) {
  Cursor cursor(encoding, message);
  DecodedOdometry odometry;
  odometry.header_ns = cursor.header_ns();
  cursor.text();  // child_frame_id
  for (double& part : odometry.position_m) part = cursor.number<double>();
  for (double& part : odometry.orientation.coeffs()) part = cursor.number<double>();  // x, y, z, w
  cursor.numbers(36 + 6 + 36);  // the pose's covariance; the velocity and its covariance
  if (!cursor.at_end()) return std::nullopt;
  return odometry;
}

bool decode_transforms(Encoding encoding, std::span<const std::byte> message,
                       std::vector<DecodedTransform>& transforms) {
  transforms.clear();
  Cursor cursor(encoding, message);
  const auto count = cursor.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count && cursor.whole(); ++i) transforms.push_back(decode_transform(cursor));
  return cursor.at_end();
}

}  // namespace sweepscope
