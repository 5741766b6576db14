#pragma once

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/core/recording/message_allocator.hpp"
#include "tests/scratch_folder.hpp"

namespace sweepscope::test {

/// The folder of real recordings, or empty where there is none.
inline std::filesystem::path real_data() {
  const char* override_path = std::getenv("SWEEPSCOPE_REAL_DATA");
  const std::filesystem::path folder = override_path
                                           ? std::filesystem::path(override_path)
                                           : std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "../shared/data";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

using LaserScanMessage = sensor_msgs::LaserScan_<MessageAllocator<void>>;
using JointStateMessage = sensor_msgs::JointState_<MessageAllocator<void>>;

inline constexpr double kStart_s = 1000;  // header stamps of the sample recording begin here
inline constexpr double kReceiveDelay_s = 0.005;

inline LaserScanMessage sample_scan(double stamp_s, const std::vector<float>& ranges = {1, 2, 3, 4, 5}) {
  LaserScanMessage scan;
  if (stamp_s != 0) scan.header.stamp = ros::Time(stamp_s);
  scan.header.frame_id = "laser";
  scan.angle_min = -0.5F;
  scan.angle_max = 0.5F;
  scan.angle_increment = 0.25F;
  scan.time_increment = 0.001F;
  scan.scan_time = 0.025F;
  scan.range_min = 0.1F;
  scan.range_max = 30;
  scan.ranges.assign(ranges.begin(), ranges.end());
  return scan;
}

inline JointStateMessage sample_joints(double stamp_s, const std::vector<std::string>& names,
                                       const std::vector<double>& positions) {
  JointStateMessage state;
  if (stamp_s != 0) state.header.stamp = ros::Time(stamp_s);
  for (const std::string& name : names) state.name.emplace_back(name.begin(), name.end());
  state.position.assign(positions.begin(), positions.end());
  return state;
}

/// The motor of the sample recording: a triangle between -1 and 1 rad, 0.5 s from reversal to reversal, at -1
/// at 0 s.
inline double sample_angle_rad(double since_s) {
  const double phase = std::fmod(since_s, 1.0);
  return phase < 0.5 ? -1 + 4 * phase : 3 - 4 * phase;
}

inline rosbag::CompressionType ros_compression(const std::string& name) {
  return name == "bz2"   ? rosbag::compression::BZ2
         : name == "lz4" ? rosbag::compression::LZ4
                         : rosbag::compression::Uncompressed;
}

/// A bag being written by librosbag_storage.
class TestBag {
 public:
  explicit TestBag(const std::filesystem::path& path, const std::string& compression = "none",
                   std::uint32_t chunk_bytes = 4096) {
    bag_.open(path.string(), rosbag::bagmode::Write);
    bag_.setCompression(ros_compression(compression));
    bag_.setChunkThreshold(chunk_bytes);
  }

  template <typename Message>
  void write(const std::string& topic, double receive_s, const Message& message) {
    bag_.write(topic, ros::Time(receive_s), message);
  }
  void scan(double stamp_s) { write("/scan", stamp_s + kReceiveDelay_s, sample_scan(stamp_s)); }
  void motor(double stamp_s) {
    write("/joint_states", stamp_s + kReceiveDelay_s,
          sample_joints(stamp_s, {"roll_motor"}, {sample_angle_rad(stamp_s - kStart_s)}));
  }
  void close() { bag_.close(); }

 private:
  rosbag::Bag bag_;
};

inline constexpr int kSampleScans = 160, kSampleMotor = 420;

/// 4 s of a rolling laser: 160 scans of 5 beams at 40 Hz, and 420 motor samples at 100 Hz from 0.1 s before
/// to 0.1 s after them.
inline void write_sample_bag(const std::filesystem::path& path, const std::string& compression = "none") {
  TestBag bag(path, compression);
  int scans = 0;
  for (int i = 0; i < kSampleMotor; ++i) {
    const double since_s = 0.01 * i - 0.1;
    for (; scans < kSampleScans && 0.025 * scans <= since_s; ++scans) bag.scan(kStart_s + 1 + 0.025 * scans);
    bag.motor(kStart_s + 1 + since_s);
  }
  bag.close();
}

/// One record of a bag as bytes, for files that no writer would write.
struct RawBag {
  static std::string number(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += i < 8 ? static_cast<char>(value >> (8 * i) & 0xFF) : '\0';
    return text;
  }
  static std::string counted(const std::string& bytes) { return number(bytes.size(), 4) + bytes; }
  static std::string record(const std::vector<std::string>& fields, const std::string& data) {
    std::string header;
    for (const std::string& field : fields) header += counted(field);
    return counted(header) + counted(data);
  }
  static std::string magic() { return "#ROSBAG V2.0\n"; }
  static std::string bag_header(std::uint64_t index_at) {
    return record({"op=\x03", "index_pos=" + number(index_at, 8), "conn_count=" + number(1, 4),
                   "chunk_count=" + number(1, 4)},
                  std::string(64, ' '));
  }
  static std::string connection(std::uint32_t id, const std::string& topic, const std::string& type,
                                const std::string& md5sum = "*") {
    return record({"op=\x07", "conn=" + number(id, 4), "topic=" + topic},
                  counted("type=" + type) + counted("md5sum=" + md5sum));
  }
  static std::string message(std::uint32_t id, std::uint32_t receive_s, const std::string& data) {
    return record({"op=\x02", "conn=" + number(id, 4), "time=" + number(receive_s, 8)}, data);
  }
  static std::string chunk(const std::string& compression, std::uint64_t claimed_bytes,
                           const std::string& data) {
    return record({"op=\x05", "compression=" + compression, "size=" + number(claimed_bytes, 4)}, data);
  }
};

}  // namespace sweepscope::test
