#include "core/recording/messages/messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <numbers>

#include "core/numbers.hpp"
#include "core/recording/messages/message_archives.hpp"

namespace sweepscope {

namespace {

constexpr MessageType kTypes[] = {
    {"sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369", MessageKind::kLaserScan},
    {"sensor_msgs/MultiEchoLaserScan", "6fefb0c6da89d7c8abe4b339f5c2f8fb", MessageKind::kMultiEcho},
    {"sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181", MessageKind::kCloud},
    {"livox_ros_driver/CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6", MessageKind::kLivox},
    {"livox_ros_driver2/CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6", MessageKind::kLivox},
    {"sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd", MessageKind::kJointState},
    {"dynamixel_msgs/JointState", "2b8449320cde76616338e2539db27c32", MessageKind::kFields},
    {"dynamixel_workbench_msgs/DynamixelStateList", "*", MessageKind::kFields},
    {"control_msgs/JointControllerState", "987ad85e4756f3aef7f1e5e7fe0595d1", MessageKind::kFields},
    {"control_msgs/JointTrajectoryControllerState", "10817c60c2486ef6b33e97dcd87f4474", MessageKind::kFields},
    {"std_msgs/Float64", "fdb28210bfa9d7c91146260178d9a584", MessageKind::kFields},
    {"std_msgs/Float32", "73fcbf46b49191e672908e50842a83d4", MessageKind::kFields},
    {"std_msgs/Int32", "da5909fbe378aeaf85e547e830cc1bb7", MessageKind::kFields},
    {"tf/tfMessage", "94810edda583a504dfda3829e70d7eec", MessageKind::kTransforms},
    {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec", MessageKind::kTransforms},
    {"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2", MessageKind::kImu},
    {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7", MessageKind::kOdometry},
};

// The fields of each message, in order: for MessageReader, whose messages are not const, and MessageWriter.

template <typename Message, typename Type>
concept Is = std::same_as<std::remove_const_t<Message>, Type>;

template <typename Archive, Is<ScanMessage> Scan>
void visit_fields(Archive& archive, Scan& scan) {
  archive.header(scan.header_ns, scan.frame);
  archive.numbers(scan.angle_min_rad, scan.angle_max_rad, scan.angle_increment_rad, scan.time_increment_s,
                  scan.scan_time_s, scan.range_min_m, scan.range_max_m);
  archive.array(scan.ranges_m);
  archive.array(scan.intensities);
}

template <typename Archive, Is<CloudMessage> Cloud>
void visit_fields(Archive& archive, Cloud& cloud) {
  constexpr std::uint32_t kMaxFields = 256;
  archive.header(cloud.header_ns, cloud.frame);
  archive.numbers(cloud.height, cloud.width);
  const auto visit_field = [](Archive& of_field, auto& field) {
    of_field.text(field.name);
    of_field.numbers(field.offset, field.datatype, field.count);
  };
  archive.list(cloud.fields, visit_field, kMaxFields);
  archive.flag(cloud.swapped);
  archive.numbers(cloud.point_bytes, cloud.row_bytes);
  archive.bytes(cloud.data);
  archive.flag(cloud.dense);
}

template <typename Archive, Is<JointStateMessage> JointState>
void visit_fields(Archive& archive, JointState& state) {
  archive.header(state.header_ns, state.frame);
  archive.list(state.joints, [](Archive& of_joint, auto& joint) { of_joint.text(joint.name); });
  archive.array(state.positions);
  archive.array(state.velocities);
  archive.array(state.efforts);
}

template <typename Archive, Is<ImuMessage> Imu>
void visit_fields(Archive& archive, Imu& imu) {
  archive.header(imu.header_ns, imu.frame);
  archive.numbers(imu.orientation.coeffs(), imu.orientation_covariance, imu.rate_rad_s, imu.rate_covariance,
                  imu.acceleration_mps2, imu.acceleration_covariance);
}

template <typename Archive, Is<std::vector<TransformMessage>> Transforms>
void visit_fields(Archive& archive, Transforms& transforms) {
  archive.list(transforms, [](Archive& of_transform, auto& transform) {
    of_transform.header(transform.header_ns, transform.parent);
    of_transform.text(transform.child);
    of_transform.numbers(transform.translation_m, transform.rotation.coeffs());  // x, y, z, w
  });
}

/// False if the message is malformed.
template <typename Message>
bool decode(Encoding encoding, std::span<const std::byte> bytes, Message& message) {
  MessageReader reader(encoding, bytes);
  visit_fields(reader, message);
  return reader.at_end();
}

bool decode_joint_state(Encoding encoding, std::span<const std::byte> message,
                        std::vector<DecodedJoint>& joints) {
  JointStateMessage state;
  state.joints.swap(joints);
  const bool whole = decode(encoding, message, state);
  joints.swap(state.joints);
  if (state.positions.size() == 0) joints.clear();
  if (!whole || state.positions.size() != joints.size()) return false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i].header_ns = state.header_ns;
    joints[i].position = state.positions[i];
  }
  return true;
}

struct CloudNumber {
  std::size_t size = 0;
  double (*load)(const std::byte* bytes, bool swapped) = nullptr;
};

template <typename T>
constexpr CloudNumber cloud_number() {
  return {sizeof(T), [](const std::byte* bytes, bool swapped) {
            return static_cast<double>(loaded<T>(bytes, swapped));
          }};
}

/// As sensor_msgs/PointField numbers them, from 1.
constexpr CloudNumber kCloudNumbers[] = {{},
                                         cloud_number<std::int8_t>(),
                                         cloud_number<std::uint8_t>(),
                                         cloud_number<std::int16_t>(),
                                         cloud_number<std::uint16_t>(),
                                         cloud_number<std::int32_t>(),
                                         cloud_number<std::uint32_t>(),
                                         cloud_number<float>(),
                                         cloud_number<double>()};

bool decode_turned_frames(Encoding encoding, std::span<const std::byte> message, const Eigen::Vector3d& axis,
                          std::vector<DecodedJoint>& joints) {
  std::vector<TransformMessage> frames;
  const bool whole = decode(encoding, message, frames);
  for (const TransformMessage& frame : frames)
    joints.push_back(
        {frame.header_ns, frame.child, angle_about(axis, frame.rotation.vec(), frame.rotation.w())});
  return whole;
}

}  // namespace

std::string short_type_name(std::string_view name) {
  std::string shorter(name);
  if (const std::size_t at = shorter.find("/msg/"); at != std::string::npos) shorter.erase(at, 4);
  return shorter;
}

const MessageType* find_message_type(std::string_view name) {
  const auto* const found = std::ranges::find(kTypes, short_type_name(name), &MessageType::name);
  return found == std::end(kTypes) ? nullptr : found;
}

double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& vector, double scalar) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return std::remainder(2 * std::atan2(axis.dot(vector), scalar), kTurn);
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

template <typename Message>
std::string encode(Encoding encoding, const Message& message, std::uint32_t sequence) {
  MessageWriter writer(encoding, sequence);
  visit_fields(writer, message);
  return writer.take();
}

template std::string encode(Encoding, const ScanMessage&, std::uint32_t);
template std::string encode(Encoding, const CloudMessage&, std::uint32_t);
template std::string encode(Encoding, const JointStateMessage&, std::uint32_t);
template std::string encode(Encoding, const ImuMessage&, std::uint32_t);
template std::string encode(Encoding, const std::vector<TransformMessage>&, std::uint32_t);

bool holds_stamp(Encoding encoding, std::int64_t ns) {
  const std::int64_t max_s = encoding == Encoding::kCdr
                                 ? std::int64_t{std::numeric_limits<std::int32_t>::max()}
                                 : std::int64_t{std::numeric_limits<std::uint32_t>::max()};
  return ns >= 0 && ns / kSecond_ns <= max_s;
}

std::optional<ScanMessage> decode_laser_scan(Encoding encoding, std::span<const std::byte> message) {
  ScanMessage scan;
  return decode(encoding, message, scan) ? std::optional(scan) : std::nullopt;
}

std::size_t CloudField::size() const {
  return datatype < std::size(kCloudNumbers) ? kCloudNumbers[datatype].size : 0;
}

double CloudMessage::value(std::size_t point, const CloudField& field) const {
  const std::byte* bytes =
      data.data() + point / width * row_bytes + point % width * point_bytes + field.offset;
  return kCloudNumbers[field.datatype].load(bytes, swapped);
}

std::optional<CloudMessage> decode_cloud(Encoding encoding, std::span<const std::byte> message) {
  CloudMessage cloud;
  if (!decode(encoding, message, cloud)) return std::nullopt;
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

std::optional<CloudMessage> decode_livox(Encoding encoding, std::span<const std::byte> message) {
  constexpr std::uint32_t kPoint_bytes = 19, kPointInCdr_bytes = 20;
  constexpr std::uint64_t kSince1970_ns = 100'000'000'000'000'000, kLatest_ns = std::uint64_t{1} << 62;
  constexpr std::uint8_t kUint8 = 2, kUint32 = 6, kFloat32 = 7;
  MessageReader reader(encoding, message);
  CloudMessage cloud;
  std::uint64_t base_ns = 0;
  std::uint32_t point_num = 0;  // the array says it too
  std::array<std::uint8_t, 4> id_and_reserved{};
  reader.header(cloud.header_ns, cloud.frame);
  reader.numbers(base_ns, point_num, id_and_reserved, cloud.width);
  cloud.height = 1;
  cloud.point_bytes = encoding == Encoding::kCdr ? kPointInCdr_bytes : kPoint_bytes;
  cloud.row_bytes = cloud.width * cloud.point_bytes;
  cloud.data = reader.records(cloud.width, kPoint_bytes);
  cloud.swapped = reader.swapped();
  if (!reader.at_end() || cloud.data.size() > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
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
  if (kind == MessageKind::kJointState) return decode_joint_state(encoding, message, joints);
  return kind == MessageKind::kTransforms && decode_turned_frames(encoding, message, axis, joints);
}

std::optional<ImuMessage> decode_imu(Encoding encoding, std::span<const std::byte> message) {
  ImuMessage imu;
  if (!decode(encoding, message, imu) || imu.rate_covariance[0] == -1) return std::nullopt;
  return imu;
}

std::optional<OdometryMessage> decode_odometry(Encoding encoding, std::span<const std::byte> message) {
  MessageReader reader(encoding, message);
  OdometryMessage odometry;
  std::string_view frame, child;
  std::array<double, 36 + 6 + 36> rest{};  // the pose's covariance; the velocity and its covariance
  reader.header(odometry.header_ns, frame);
  reader.text(child);
  reader.numbers(odometry.position_m, odometry.orientation.coeffs(), rest);
  return reader.at_end() ? std::optional(odometry) : std::nullopt;
}

bool decode_transforms(Encoding encoding, std::span<const std::byte> message,
                       std::vector<TransformMessage>& transforms) {
  transforms.clear();
  return decode(encoding, message, transforms);
}

}  // namespace sweepscope
