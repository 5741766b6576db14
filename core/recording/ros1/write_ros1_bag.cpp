#include "core/recording/ros1/write_ros1_bag.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "core/io/atomic_file.hpp"
#include "core/io/temporary_file.hpp"
#include "core/numbers.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/recording/ros1/ros_libraries.hpp"

namespace sweepscope {
namespace {

using LaserScanMessage = sensor_msgs::LaserScan_<MessageAllocator<void>>;
using PointCloudMessage = sensor_msgs::PointCloud2_<MessageAllocator<void>>;
using ImuMessage = sensor_msgs::Imu_<MessageAllocator<void>>;
using JointStateMessage = sensor_msgs::JointState_<MessageAllocator<void>>;

ros::Time ros_time(std::int64_t ns) {
  if (ns < 0 || ns / kSecond_ns > std::numeric_limits<std::uint32_t>::max())
    throw std::out_of_range(fmt::format("a ROS 1 bag holds no time {} s", ns / kSecond_ns));
  return {static_cast<std::uint32_t>(ns / kSecond_ns), static_cast<std::uint32_t>(ns % kSecond_ns)};
}

LaserScanMessage scan_message(const RawLaser& laser, std::size_t number) {
  const RawScan& scan = laser.scans[number];
  LaserScanMessage message;
  message.header.seq = static_cast<std::uint32_t>(number);
  message.header.stamp = ros_time(scan.stamps.header_ns);
  message.header.frame_id = "laser";
  message.angle_min = scan.angle_min_rad;
  message.angle_increment = scan.angle_increment_rad;
  message.angle_max = scan.angle_max_rad;
  message.time_increment = scan.time_increment_s;
  message.scan_time = scan.scan_time_s;
  message.range_min = scan.range_min_m;
  message.range_max = scan.range_max_m;
  const auto first = static_cast<std::ptrdiff_t>(scan.first_range);
  const auto ranges = laser.ranges_m.begin() + first;
  message.ranges.assign(ranges, ranges + scan.beams);
  if (laser.has_intensities) {
    const auto intensities = laser.intensities.begin() + first;
    message.intensities.assign(intensities, intensities + scan.beams);
  }
  return message;
}

PointCloudMessage cloud_message(const RawCloud& cloud, std::size_t number) {
  PointCloudMessage message;
  message.header.seq = static_cast<std::uint32_t>(number);
  message.header.stamp = ros_time(cloud.stamps.header_ns);
  message.header.frame_id.assign(cloud.frame.begin(), cloud.frame.end());
  message.height = cloud.height;
  message.width = cloud.width;
  for (const RawCloud::Field& field : cloud.fields) {
    auto& added = message.fields.emplace_back();
    added.name.assign(field.name.begin(), field.name.end());
    added.offset = field.offset;
    added.datatype = field.datatype;
    added.count = field.count;
  }
  message.is_bigendian = cloud.big_endian;
  message.point_step = cloud.point_bytes;
  message.row_step = cloud.row_bytes;
  message.data.resize(cloud.data.size());
  std::memcpy(message.data.data(), cloud.data.data(), cloud.data.size());
  message.is_dense = cloud.dense;
  return message;
}

JointStateMessage joint_message(const RawJoint& joint, std::size_t number) {
  JointStateMessage message;
  message.header.seq = static_cast<std::uint32_t>(number);
  message.header.stamp = ros_time(joint.stamps[number].header_ns);
  message.name.emplace_back(joint.joint.begin(), joint.joint.end());
  message.position = {joint.positions[number]};
  message.velocity = {0.0};  // as many drivers leave it
  message.effort = {0.0};
  return message;
}

/// An orientation and an acceleration are not measured: -1, as the message's definition has it.
ImuMessage imu_message(const RawTurnRates& rates, std::size_t number) {
  ImuMessage message;
  message.header.seq = static_cast<std::uint32_t>(number);
  message.header.stamp = ros_time(rates.stamps[number].header_ns);
  message.header.frame_id = "imu";
  message.orientation_covariance[0] = message.linear_acceleration_covariance[0] = -1;
  message.angular_velocity.x = rates.rates_rad_s[number].x();
  message.angular_velocity.y = rates.rates_rad_s[number].y();
  message.angular_velocity.z = rates.rates_rad_s[number].z();
  return message;
}

rosbag::CompressionType compression_of(const std::string& name) {
  if (name == "bz2") return rosbag::compression::BZ2;
  if (name == "lz4") return rosbag::compression::LZ4;
  return rosbag::compression::Uncompressed;
}

/// A bag being written. rosbag's destructor writes what is left, and ends the program where that fails, as on
/// a full disk: a bag whose `close` did not succeed is never destroyed.
class BagFile {
 public:
  BagFile() = default;
  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;
  ~BagFile() {
    static auto* const never_destroyed =
        new std::vector<std::unique_ptr<rosbag::Bag>>;  // NOLINT(bugprone-unhandled-exception-at-new)
    if (bag_) never_destroyed->push_back(std::move(bag_));
  }

  void open(const std::filesystem::path& path, const std::string& compression) {
    const RosHome home;
    bag_ = std::make_unique<rosbag::Bag>();
    bag_->open(path.string(), rosbag::bagmode::Write);
    bag_->setCompression(compression_of(compression));
  }
  template <typename Message>
  void write(const std::string& topic, ros::Time received, const Message& message) {
    bag_->write(topic, received, message);
  }
  void close() {
    bag_->close();
    bag_.reset();
  }

 private:
  std::unique_ptr<rosbag::Bag> bag_;
};

/// False where the job was cancelled. Throws what rosbag throws.
bool write_messages(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                    const std::string& compression, const Job& job, const std::optional<RawImu>& imu) {
  BagFile bag;
  bag.open(path, compression);
  const std::vector<WrittenMessage> all = write_order(laser, joint);
  std::size_t imu_number = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (job.cancelled()) return false;
    for (; imu && imu_number < imu->rates.stamps.size(); ++imu_number) {
      const std::int64_t received_ns = imu->rates.stamps[imu_number].receive_ns;
      if (received_ns > all[i].receive_ns) break;
      bag.write(imu->topic, ros_time(received_ns), imu_message(imu->rates, imu_number));
    }
    const ros::Time received = std::max(ros_time(all[i].receive_ns), ros::TIME_MIN);
    if (all[i].is_scan && laser.of_clouds)
      bag.write(laser.topic, received, cloud_message(laser.clouds[all[i].number], all[i].number));
    else if (all[i].is_scan)
      bag.write(laser.topic, received, scan_message(laser, all[i].number));
    else
      bag.write(joint.topic, received, joint_message(joint, all[i].number));
    if (i % 512 == 0) job.report("writing", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  bag.close();
  return true;
}

/// The messages as a bag at `path`; `output` is named in errors.
Result<void> write_messages_into(const std::filesystem::path& path, const AtomicFile& output,
                                 const RawLaser& laser, const RawJoint& joint, const std::string& compression,
                                 const Job& job, const std::optional<RawImu>& imu) {
  errno = 0;
  try {
    if (write_messages(laser, joint, path, compression, job, imu)) return {};
    return failure(ExitCode::kInterrupted, "interrupted");
  } catch (const std::exception& error) {
    // rosbag says less than the system.
    return tl::unexpected(output.error(errno != 0 ? std::strerror(errno) : error.what()));
  }
}

Result<void> copy_into(AtomicFile& output, const std::filesystem::path& path, const Job& job) {
  constexpr std::size_t kBlock_bytes = std::size_t{1} << 20;
  std::string block(kBlock_bytes, '\0');
  std::ifstream input(path, std::ios::binary);
  while (input.read(block.data(), static_cast<std::streamsize>(block.size())), input.gcount() > 0) {
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
    const auto got = static_cast<std::size_t>(input.gcount());
    if (auto written = output.write(std::string_view(block).substr(0, got)); !written) return written;
  }
  return {};
}

}  // namespace

Result<void> write_ros1_bag(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                            const std::string& compression, const Job& job,
                            const std::optional<RawImu>& imu) {
  auto output = AtomicFile::create(path);
  if (!output) return tl::unexpected(output.error());
  if (!output->part_path().empty())
    return write_messages_into(output->part_path(), *output, laser, joint, compression, job, imu)
        .and_then([&] { return output->commit(); });
  // rosbag goes back to the beginning of its file, which a pipe or a device does not allow.
  const auto whole = TemporaryFile::create();
  if (!whole) return tl::unexpected(whole.error());
  return write_messages_into(whole->path(), *output, laser, joint, compression, job, imu)
      .and_then([&] { return copy_into(*output, whole->path(), job); })
      .and_then([&] { return output->commit(); });
}

}  // namespace sweepscope
