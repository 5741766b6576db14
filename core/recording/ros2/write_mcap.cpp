#include "core/recording/ros2/write_mcap.hpp"

#include <array>

#include "core/recording/raw_recording.hpp"
#include "core/recording/ros2/cdr_writer.hpp"
#include "core/recording/ros2/mcap_writer.hpp"

namespace sweepscope {
namespace {

constexpr std::uint16_t kScans = 0, kJoints = 1;  // the channels, in the order in which they are added

McapChannel channel(std::string topic, const char* type, std::string definition) {
  return {std::move(topic), "cdr", type, "", "ros2msg", std::move(definition), {}};
}

Result<void> add_channels(const RawLaser& laser, const RawJoint& joint, McapWriter& writer) {
  const McapChannel scans =
      laser.of_clouds ? channel(laser.topic, "sensor_msgs/msg/PointCloud2", point_cloud_definition())
                      : channel(laser.topic, "sensor_msgs/msg/LaserScan", laser_scan_definition());
  const McapChannel joints = channel(joint.topic, "sensor_msgs/msg/JointState", joint_state_definition());
  return writer.add_channel(scans)
      .and_then([&](std::uint16_t) { return writer.add_channel(joints); })
      .map([](std::uint16_t) {});
}

/// A scan, or a cloud where the laser's are clouds.
std::string laser_message(const RawLaser& laser, std::size_t number) {
  return laser.of_clouds ? cdr_cloud(laser.clouds[number]) : cdr_laser_scan(laser, number);
}

const MessageStamps& laser_stamps(const RawLaser& laser, std::size_t number) {
  return laser.of_clouds ? laser.clouds[number].stamps : laser.scans[number].stamps;
}

Result<void> write_messages(const RawLaser& laser, const RawJoint& joint, McapWriter& writer,
                            const Job& job) {
  const std::vector<WrittenMessage> all = write_order(laser, joint);
  std::array<std::uint32_t, 2> sequence{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
    const std::size_t number = all[i].number;
    const std::uint16_t channel = all[i].is_scan ? kScans : kJoints;
    const auto& stamps = all[i].is_scan ? laser_stamps(laser, number) : joint.stamps[number];
    const std::string data = all[i].is_scan ? laser_message(laser, number) : cdr_joint_state(joint, number);
    auto written = writer.write({channel, sequence[channel]++, static_cast<std::uint64_t>(all[i].receive_ns),
                                 static_cast<std::uint64_t>(stamps.header_ns)},
                                std::as_bytes(std::span(data)));
    if (!written) return written;
    if (i % 512 == 0) job.report("writing", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  return {};
}

}  // namespace

Result<void> write_mcap(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                        const std::string& compression, const Job& job) {
  auto writer = McapWriter::create(path, mcap_compression(compression).value_or(Compression::kNone), "ros2");
  if (!writer) return tl::unexpected(writer.error());
  return add_channels(laser, joint, *writer)
      .and_then([&] { return write_messages(laser, joint, *writer, job); })
      .and_then([&] { return writer->finish(); });
}

}  // namespace sweepscope
