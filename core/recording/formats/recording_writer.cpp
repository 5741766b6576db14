#include "core/recording/formats/recording_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "core/numbers.hpp"
#include "core/recording/csv/csv_recording.hpp"
#include "core/recording/messages/raw_messages.hpp"
#include "core/recording/ros2/mcap_records.hpp"
#include "core/recording/streams/message_sink.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// The topics of a recording as a sink numbers them.
enum Topic : std::size_t { kLaser, kJoint, kImu };

/// Writes the messages of a laser, a joint and perhaps an IMU.
class RecordingMessages {
 public:
  RecordingMessages(const RawLaser& laser, const RawJoint& joint, const std::optional<RawImu>& imu,
                    Encoding encoding, const fs::path& output)
      : laser_(laser), joint_(joint), imu_(imu), encoding_(encoding), output_(output) {}

  Result<void> write(MessageSink& sink, const Job& job) const {
    if (auto added = add_topics(sink); !added) return added;
    const std::vector<WrittenMessage> all = write_order(laser_, joint_);
    std::size_t imu_number = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
      for (; imu_ && imu_number < imu_->rates.stamps.size(); ++imu_number) {
        const MessageStamps& stamps = imu_->rates.stamps[imu_number];
        if (stamps.receive_ns > all[i].receive_ns) break;
        if (auto written = put(sink, kImu, imu_->rates, imu_number, stamps.receive_ns, stamps.header_ns);
            !written)
          return written;
      }
      const auto [receive_ns, is_scan, number] = all[i];
      const auto written =
          is_scan ? put(sink, kLaser, laser_, number, receive_ns, laser_stamp_ns(number))
                  : put(sink, kJoint, joint_, number, receive_ns, joint_.stamps[number].header_ns);
      if (!written) return written;
      if (i % 512 == 0) job.report("writing", static_cast<double>(i) / static_cast<double>(all.size()));
    }
    return sink.finish({});
  }

 private:
  Result<void> add_topics(MessageSink& sink) const {
    std::vector<StreamTopic> topics{
        written_topic(laser_.topic, laser_.of_clouds ? "sensor_msgs/PointCloud2" : "sensor_msgs/LaserScan",
                      encoding_),
        written_topic(joint_.topic, "sensor_msgs/JointState", encoding_)};
    if (imu_) topics.push_back(written_topic(imu_->topic, "sensor_msgs/Imu", encoding_));
    for (const StreamTopic& topic : topics)
      if (auto added = sink.add_topic(topic); !added) return added;
    return {};
  }
  std::int64_t laser_stamp_ns(std::size_t number) const {
    return laser_.of_clouds ? laser_.clouds[number].stamps.header_ns : laser_.scans[number].stamps.header_ns;
  }
  template <typename Raw>
  Result<void> put(MessageSink& sink, Topic topic, const Raw& raw, std::size_t number,
                   std::int64_t receive_ns, std::int64_t header_ns) const {
    constexpr std::int64_t kFirst_ns = 1;  // at 0, rosbag's readers pass over a message
    if (!holds_stamp(encoding_, header_ns))
      return failure(ExitCode::kWrongUsage,
                     fmt::format("{}: cannot be written: a message's header holds no time {} s",
                                 output_.string(), header_ns / kSecond_ns));
    const std::string bytes = message_of(encoding_, raw, number);
    if (encoding_ == Encoding::kRos1 && receive_ns == 0) receive_ns = kFirst_ns;
    return sink.write({topic, receive_ns, header_ns, static_cast<std::uint32_t>(number), 0,
                       Compression::kNone, std::as_bytes(std::span(bytes))});
  }

  const RawLaser& laser_;
  const RawJoint& joint_;
  const std::optional<RawImu>& imu_;
  Encoding encoding_;
  const fs::path& output_;
};

Result<std::unique_ptr<MessageSink>> create_sink(RecordingFormat format, const std::string& compression,
                                                 const fs::path& path) {
  if (format == RecordingFormat::kRos1)
    return create_ros1_sink(path, compression_named(compression).value_or(Compression::kNone));
  return create_mcap_sink(path, mcap_compression(compression).value_or(Compression::kNone), "ros2", {});
}

}  // namespace

std::optional<RecordingFormat> recording_format(std::string_view name) {
  if (name == "csv") return RecordingFormat::kCsv;
  if (name == "ros1") return RecordingFormat::kRos1;
  if (name == "mcap") return RecordingFormat::kMcap;
  return std::nullopt;
}

std::optional<RecordingFormat> recording_format_of(const std::filesystem::path& output) {
  const std::string extension = output.extension().string();
  if (extension.empty()) return RecordingFormat::kCsv;
  if (extension == ".bag") return RecordingFormat::kRos1;
  if (extension == ".mcap") return RecordingFormat::kMcap;
  return std::nullopt;
}

bool can_compress(RecordingFormat format, std::string_view compression) {
  if (compression == "none") return true;
  if (format == RecordingFormat::kRos1) return compression == "bz2" || compression == "lz4";
  return format == RecordingFormat::kMcap && (compression == "lz4" || compression == "zstd");
}

std::vector<std::string> written_files(const std::filesystem::path& output, RecordingFormat format) {
  if (format != RecordingFormat::kCsv) return {output.string()};
  return {(output / kScansCsv).string(), (output / kMotorCsv).string()};
}

Result<void> write_recording(const RawLaser& laser, const RawJoint& joint, RecordingFormat format,
                             const std::string& compression, const fs::path& output, const Job& job,
                             const std::optional<RawImu>& imu) {
  if (format == RecordingFormat::kCsv) return write_csv_recording(laser, joint, output, job);
  const Encoding encoding = format == RecordingFormat::kRos1 ? Encoding::kRos1 : Encoding::kCdr;
  return create_sink(format, compression, output).and_then([&](std::unique_ptr<MessageSink>&& sink) {
    return RecordingMessages(laser, joint, imu, encoding, output).write(*sink, job);
  });
}

}  // namespace sweepscope
