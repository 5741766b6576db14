#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

enum class RecordingFormat { kCsv, kRos1, kMcap };

/// "csv", "ros1" or "mcap"; empty for any other name.
std::optional<RecordingFormat> recording_format(std::string_view name);
/// The format by an output's name: .bag, .mcap, or a folder of CSV tables if the name has no
/// extension; empty for others.
std::optional<RecordingFormat> recording_format_of(const std::filesystem::path& output);

/// The compressions of the chunks of each format: "none"; "bz2" and "lz4" for ROS 1; "lz4" and "zstd"
/// for MCAP.
bool can_compress(RecordingFormat format, std::string_view compression);

/// The files that `write_recording` writes: the output, or the tables in its folder.
std::vector<std::string> written_files(const std::filesystem::path& output, RecordingFormat format);

/// An IMU's gyroscope as a topic of sensor_msgs/Imu.
struct RawImu {
  std::string topic;
  RawTurnRates rates;
};

/// Writes a laser and a motor's joint as they were read: both stamps, unfiltered ranges, positions before the
/// rig's scale and zero, the names of topics and joint. All formats read back as the same recording. ROS 1
/// bags are of format 2.0, MCAP files of the ROS 2 profile; their messages are in the order in which they
/// were received, and one without a receive time gets its header stamp. Equal input gives equal bytes. Clouds
/// must have been read completely (CloudDetail). Neither they nor an IMU are written as CSV.
Result<void> write_recording(const RawLaser& laser, const RawJoint& joint, RecordingFormat format,
                             const std::string& compression, const std::filesystem::path& output,
                             const Job& job, const std::optional<RawImu>& imu = std::nullopt);

}  // namespace sweepscope
