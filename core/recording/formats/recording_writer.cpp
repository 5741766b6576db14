#include "core/recording/formats/recording_writer.hpp"

#include "core/recording/csv/csv_recording.hpp"
#include "core/recording/ros1/write_ros1_bag.hpp"
#include "core/recording/ros2/write_mcap.hpp"

namespace sweepscope {

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
                             const std::string& compression, const std::filesystem::path& output,
                             const Job& job) {
  if (format == RecordingFormat::kRos1) return write_ros1_bag(laser, joint, output, compression, job);
  if (format == RecordingFormat::kMcap) return write_mcap(laser, joint, output, compression, job);
  return write_csv_recording(laser, joint, output, job);
}

}  // namespace sweepscope
