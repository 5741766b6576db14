#include "core/recording/ros2/write_mcap.hpp"

#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <limits>

#include "core/io/atomic_file.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/recording/ros2/cdr_writer.hpp"
#include "core/recording/ros2/mcap_content.hpp"
#include "core/recording/ros2/mcap_records.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kChunk_bytes = std::size_t{768} << 10;
constexpr int kZstdLevel = 3;
enum ChannelId : std::uint16_t { kScans = 1, kJoints = 2 };
constexpr std::array<std::uint16_t, 2> kChannels{kScans, kJoints};

using Content = McapContent;

std::string packed(const std::string& bytes, const std::string& compression) {
  if (compression == "lz4") {
    std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    return out;
  }
  if (compression == "zstd") {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel));
    return out;
  }
  return bytes;
}

/// The times of the messages of a chunk or of the whole file.
struct TimeSpan {
  std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max(), last_ns = 0;

  void add(std::uint64_t ns) {
    first_ns = std::min(first_ns, ns);
    last_ns = std::max(last_ns, ns);
  }
  std::uint64_t start_ns() const { return std::min(first_ns, last_ns); }
};

/// Writes one file, chunk by chunk.
class McapWriter {
 public:
  McapWriter(AtomicFile& file, std::string compression)
      : file_(file), compression_(compression == "none" ? "" : std::move(compression)) {}

  Result<void> begin(const RawLaser& laser, const std::string& joint_topic);
  Result<void> message(ChannelId channel, std::uint64_t log_ns, std::uint64_t publish_ns,
                       const std::string& data);
  Result<void> end();

 private:
  Result<void> write(const std::string& bytes);
  Result<void> end_chunk();

  AtomicFile& file_;
  std::string compression_;
  std::uint64_t at_ = 0;
  std::string descriptions_;  // the schemas and channels
  std::string chunk_;
  TimeSpan chunk_times_, times_;
  std::array<Content, 2> index_;  // of the chunk, per channel
  std::array<std::uint64_t, 2> counts_{};
  std::string chunk_indexes_;
  std::uint32_t chunks_ = 0;
};

Result<void> McapWriter::write(const std::string& bytes) {
  at_ += bytes.size();
  return file_.write(bytes);
}

Result<void> McapWriter::begin(const RawLaser& laser, const std::string& joint_topic) {
  const auto describe = [&](ChannelId id, const char* type, const std::string& definition,
                            const std::string& topic) {
    const std::uint16_t number = id;
    descriptions_ +=
        mcap_record(McapOp::kSchema, Content().number(number).text(type).text("ros2msg").text(definition));
    descriptions_ +=
        mcap_record(McapOp::kChannel,
                    Content().number(number).number(number).text(topic).text("cdr").number(std::uint32_t{0}));
  };
  if (laser.of_clouds)
    describe(kScans, "sensor_msgs/msg/PointCloud2", point_cloud_definition(), laser.topic);
  else
    describe(kScans, "sensor_msgs/msg/LaserScan", laser_scan_definition(), laser.topic);
  describe(kJoints, "sensor_msgs/msg/JointState", joint_state_definition(), joint_topic);
  chunk_ = descriptions_;
  return write(std::string(kMcapMagic) +
               mcap_record(McapOp::kHeader, Content().text("ros2").text("sweepscope " SWEEPSCOPE_VERSION)));
}

Result<void> McapWriter::message(ChannelId channel, std::uint64_t log_ns, std::uint64_t publish_ns,
                                 const std::string& data) {
  const auto sequence = static_cast<std::uint32_t>(counts_[channel - 1]++);
  index_[channel - 1].number(log_ns).number(std::uint64_t{chunk_.size()});
  chunk_times_.add(log_ns);
  times_.add(log_ns);
  chunk_ += mcap_record(McapOp::kMessage, Content()
                                              .number(static_cast<std::uint16_t>(channel))
                                              .number(sequence)
                                              .number(log_ns)
                                              .number(publish_ns)
                                              .raw(data));
  return chunk_.size() < kChunk_bytes ? Result<void>() : end_chunk();
}

/// Writes the chunk and the indexes of its messages.
Result<void> McapWriter::end_chunk() {
  if (chunk_.empty()) return {};
  boost::crc_32_type crc;
  crc.process_bytes(chunk_.data(), chunk_.size());
  const std::string records = packed(chunk_, compression_);
  const std::uint64_t chunk_at = at_;
  const std::string chunk = mcap_record(McapOp::kChunk, Content()
                                                            .number(chunk_times_.start_ns())
                                                            .number(chunk_times_.last_ns)
                                                            .number(std::uint64_t{chunk_.size()})
                                                            .number(std::uint32_t{crc.checksum()})
                                                            .text(compression_)
                                                            .number(std::uint64_t{records.size()})
                                                            .raw(records));
  std::string indexes;
  Content offsets;
  for (const std::uint16_t channel : kChannels) {
    Content& index = index_[channel - 1];
    if (index.bytes().empty()) continue;
    offsets.number(channel).number(std::uint64_t{chunk_at + chunk.size() + indexes.size()});
    indexes += mcap_record(McapOp::kMessageIndex, Content().number(channel).text(index.bytes()));
    index = {};
  }
  chunk_indexes_ += mcap_record(McapOp::kChunkIndex, Content()
                                                         .number(chunk_times_.start_ns())
                                                         .number(chunk_times_.last_ns)
                                                         .number(chunk_at)
                                                         .number(std::uint64_t{chunk.size()})
                                                         .text(offsets.bytes())
                                                         .number(std::uint64_t{indexes.size()})
                                                         .text(compression_)
                                                         .number(std::uint64_t{records.size()})
                                                         .number(std::uint64_t{chunk_.size()}));
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
  return write(chunk + indexes);
}

/// The last chunk, the summary and the footer.
Result<void> McapWriter::end() {
  if (auto ended = end_chunk(); !ended) return ended;
  std::string tail = mcap_record(McapOp::kDataEnd, Content().number(std::uint32_t{0}));
  const std::uint64_t summary_at = at_ + tail.size();
  Content counts;
  for (const std::uint16_t channel : kChannels) counts.number(channel).number(counts_[channel - 1]);
  tail += descriptions_;
  tail += mcap_record(McapOp::kStatistics, Content()
                                               .number(std::uint64_t{counts_[0] + counts_[1]})
                                               .number(std::uint16_t{2})  // schemas
                                               .number(std::uint32_t{2})  // channels
                                               .number(std::uint32_t{0})  // attachments
                                               .number(std::uint32_t{0})  // metadata
                                               .number(chunks_)
                                               .number(times_.start_ns())
                                               .number(times_.last_ns)
                                               .text(counts.bytes()));
  tail += chunk_indexes_;
  // No groups of the summary are listed, and the summary has no checksum.
  tail += mcap_record(McapOp::kFooter,
                      Content().number(summary_at).number(std::uint64_t{0}).number(std::uint32_t{0}));
  return write(tail + std::string(kMcapMagic));
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
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted");
    const std::size_t number = all[i].number;
    const auto& stamps = all[i].is_scan ? laser_stamps(laser, number) : joint.stamps[number];
    auto written =
        writer.message(all[i].is_scan ? kScans : kJoints, static_cast<std::uint64_t>(all[i].receive_ns),
                       static_cast<std::uint64_t>(stamps.header_ns),
                       all[i].is_scan ? laser_message(laser, number) : cdr_joint_state(joint, number));
    if (!written) return written;
    if (i % 512 == 0) job.report("writing", static_cast<double>(i) / static_cast<double>(all.size()));
  }
  return {};
}

}  // namespace

Result<void> write_mcap(const RawLaser& laser, const RawJoint& joint, const std::filesystem::path& path,
                        const std::string& compression, const Job& job) {
  auto file = AtomicFile::create(path);
  if (!file) return tl::unexpected(file.error());
  McapWriter writer(*file, compression);
  return writer.begin(laser, joint.topic)
      .and_then([&] { return write_messages(laser, joint, writer, job); })
      .and_then([&] { return writer.end(); })
      .and_then([&] { return file->commit(); });
}

}  // namespace sweepscope
