#include "core/recording/read_recording.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "core/recording/assemble.hpp"
#include "core/recording/input_file.hpp"
#include "core/recording/ros1_recording.hpp"

namespace sweepscope {
namespace {

constexpr std::string_view kReadable = "sweepscope reads ROS 1 bags of format 2.0";

/// A file's first bytes, as far as it has them.
Result<std::string> beginning(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::string bytes(16, '\0');
  bytes.resize(file->read(std::as_writable_bytes(std::span(bytes))));
  return bytes;
}

std::string not_readable(std::string_view start) {
  if (start.starts_with("#ROSBAG V1")) return "is a ROS 1 bag of format 1; convert it with `rosbag fix`";
  if (start.starts_with("#ROSBAG")) return "is a ROS 1 bag of an unknown format";
  if (start.starts_with("SQLite format 3")) return "is an SQLite database, as ROS 2 bags are";
  if (start.starts_with("\x89MCAP")) return "is an MCAP file";
  return "byte 0 begins no recording that is known";
}

}  // namespace

Result<Recording> read_recording(const std::filesystem::path& path, const ReadOptions& options,
                                 const Job& job) {
  const auto start = beginning(path);
  if (!start) return tl::unexpected(start.error());
  if (!start->starts_with("#ROSBAG V2.0\n")) {
    return unreadable(fmt::format("{}: {}; {}", path.string(), not_readable(*start), kReadable));
  }
  const Rig rig = options.rig.value_or(Rig{});
  auto raw = read_ros1_recording(path, rig, job);
  if (!raw) return tl::unexpected(std::move(raw.error()));
  return assemble(std::move(*raw), rig, options.stamps);
}

}  // namespace sweepscope
