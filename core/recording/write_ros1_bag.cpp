#include "core/recording/write_ros1_bag.hpp"

#include <fmt/format.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "core/io/unfinished_files.hpp"
#include "core/recording/ros_allocator.hpp"
#include "core/recording/ros_home.hpp"
#include "core/recording/write_order.hpp"

namespace sweepscope {
namespace {

using LaserScanMessage = sensor_msgs::LaserScan_<MessageAllocator<void>>;
using PointCloudMessage = sensor_msgs::PointCloud2_<MessageAllocator<void>>;
using JointStateMessage = sensor_msgs::JointState_<MessageAllocator<void>>;

ros::Time ros_time(std::int64_t ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
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

rosbag::CompressionType compression_of(const std::string& name) {
  if (name == "bz2") return rosbag::compression::BZ2;
  if (name == "lz4") return rosbag::compression::LZ4;
  return rosbag::compression::Uncompressed;
}

std::unique_ptr<rosbag::Bag> opened(const std::filesystem::path& path) {
  const RosHome home;
  return std::make_unique<rosbag::Bag>(path.string(), rosbag::bagmode::Write);
}

/// False where the job was cancelled. Throws what rosbag throws.
bool write_messages(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                    const std::string& compression, const Job& job) {
  const auto bag = opened(path);
  bag->setCompression(compression_of(compression));
  const std::vector<WrittenMessage> all = write_order(laser, joint);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (job.cancelled()) return false;
    const ros::Time received = std::max(ros_time(all[i].receive_ns), ros::TIME_MIN);
    if (all[i].is_scan && laser.of_clouds)
      bag->write(laser.topic, received, cloud_message(laser.clouds[all[i].number], all[i].number));
    else if (all[i].is_scan)
      bag->write(laser.topic, received, scan_message(laser, all[i].number));
    else
      bag->write(joint.topic, received, joint_message(joint, all[i].number));
    if (i % 512 == 0) job.report("writing", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  bag->close();
  return true;
}

}  // namespace

Result<void> write_ros1_bag(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                            const std::string& compression, const Job& job) {
  const std::filesystem::path part = path.string() + ".part";
  remember_unfinished(part);
  bool finished = false;
  std::string why;
  errno = 0;
  try {
    finished = write_messages(laser, joint, part, compression, job);
    if (finished) std::filesystem::rename(part, path);
  } catch (const std::exception& error) {
    why = errno != 0 ? std::strerror(errno) : error.what();  // rosbag says less than the system
  }
  std::error_code ignored;
  if (!finished || !why.empty()) std::filesystem::remove(part, ignored);
  forget_unfinished(part);
  if (!why.empty())
    return failure(ExitCode::kWrongUsage, fmt::format("{}: cannot be written: {}", path.string(), why));
  if (!finished) return failure(ExitCode::kInterrupted, "interrupted");
  return {};
}

}  // namespace sweepscope
