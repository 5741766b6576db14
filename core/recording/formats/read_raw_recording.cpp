#include "core/recording/formats/read_raw_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/input_file.hpp"
#include "core/recording/csv/csv_recording.hpp"
#include "core/recording/messages/message_collector.hpp"
#include "core/recording/packed/unpacked_file.hpp"
#include "core/recording/ros2/bag_files.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kReadable =
    "sweepscope reads ROS 1 bags of format 2.0, ROS 2 bags (.db3 and MCAP, packed by zstd too), folders of "
    "either, and folders with scans.csv and motor.csv";

/// A file's first bytes, as far as it has them.
Result<std::string> beginning(const fs::path& path) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::string bytes(16, '\0');
  bytes.resize(file->read(std::as_writable_bytes(std::span(bytes))));
  return bytes;
}

std::string not_readable(std::string_view start) {
  if (start.starts_with("#ROSBAG V1")) return "is a ROS 1 bag of format 1; convert it with `rosbag fix`";
  if (start.starts_with("#ROSBAG")) return "is a ROS 1 bag of an unknown format";
  if (start.starts_with("\x89MCAP")) return "is an MCAP file of an unknown version";
  if (start.starts_with("SQLite format")) return "is an SQLite database of an unknown version";
  return "its first bytes are not those of a known recording format";
}

RawRecording named_recording(const fs::path& path) {
  RawRecording raw;
  raw.file = path.string();
  raw.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  return raw;
}

/// What reading one file gave besides its messages.
struct FileReading {
  std::vector<std::string> damage;
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max(), last_ns = 0;  // receive times
};

/// Collects the messages of a file.
Result<FileReading> collect(const fs::path& path, MessageCollector& collector, const Job& job) {
  UnpackingLimit limit(path);
  const auto file = open_stream_file(path, limit, job);
  if (!file) return tl::unexpected(file.error());
  collector.begin_file(limit);
  struct Numbered {
    MessageTopic topic;
    std::string publisher;
    std::optional<std::size_t> number = {};  // given by its first message
  };
  FileReading reading;
  std::vector<Numbered> topics;
  const auto visit_topic = [&](const StreamTopic& topic) {
    topics.push_back({message_topic(topic), topic.metadata_of("callerid")});
    return topics.size() - 1;
  };
  const auto visit_message = [&](const StreamMessage& message) {
    auto& [topic, publisher, number] = topics[message.topic];
    if (!number) number = collector.number_of(topic);
    reading.first_ns = std::min(reading.first_ns, message.log_ns);
    reading.last_ns = std::max(reading.last_ns, message.log_ns);
    return collector.add(
        *number, message.log_ns, message.bytes,
        [&] {
          return file->format == StreamFormat::kSqlite ? fmt::format("message {}", message.id)
                                                       : message.place.text();
        },
        publisher);
  };
  auto damage = read_stream(*file, limit, {visit_topic, visit_message}, job);
  if (!damage) return tl::unexpected(damage.error());
  reading.damage = std::move(*damage);
  return reading;
}

/// Bags that lie in a folder by chance are not one recording.
std::optional<Error> not_together(const fs::path& folder, const std::vector<fs::path>& files,
                                  const std::vector<FileReading>& readings) {
  constexpr double kLongestBreak_s = 60;
  std::vector<std::size_t> order(files.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return readings[i].first_ns; });
  std::size_t latest = order.front();
  for (const std::size_t i : order) {
    const double break_s = static_cast<double>(readings[i].first_ns - readings[latest].last_ns) * 1e-9;
    if (readings[i].last_ns > 0 && break_s > kLongestBreak_s)
      return Error{
          ExitCode::kUnreadableInput,
          fmt::format("{}: its bags are of different recordings: {} begins {:.0f} s after the end of "
                      "{}; give one bag, or a folder with those of one recording",
                      folder.string(), files[i].filename().string(), break_s,
                      files[latest].filename().string())};
    if (readings[i].last_ns > readings[latest].last_ns) latest = i;
  }
  return std::nullopt;
}

Result<RawRecording> read_messages(const fs::path& path, const std::vector<fs::path>& files, const Rig& rig,
                                   const Job& job, const ReadDetail& detail, bool together) {
  RawRecording raw = named_recording(path);
  MessageCollector collector(rig, raw, detail);
  std::vector<std::string> damages;
  std::vector<FileReading> readings;
  for (const fs::path& file : files) {
    auto reading = collect(file, collector, job);
    if (!reading) return tl::unexpected(reading.error());
    for (const std::string& what : reading->damage)
      damages.push_back(file == path ? what : fmt::format("{}: {}", file.filename().string(), what));
    readings.push_back(std::move(*reading));
  }
  if (!together)
    if (auto error = not_together(path, files, readings)) return tl::unexpected(std::move(*error));
  collector.finish();
  raw.warnings.insert(raw.warnings.begin(), damages.begin(), damages.end());
  return raw;
}

Result<RawRecording> read_bag_folder(const fs::path& folder, const Rig& rig, const Job& job,
                                     const ReadDetail& detail) {
  const auto files = bag_files_of(folder);
  if (!files) return tl::unexpected(files.error());
  const auto stored = stored_as(files->front());
  const bool ros1 = stored && stored->storage == BagStorage::kRos1;
  auto raw = read_messages(folder, *files, rig, job, detail, !ros1);
  if (!raw || is_described(folder)) return raw;
  constexpr std::size_t kMaxNames = 10;
  std::vector<std::string> names;
  for (const fs::path& file : *files) names.push_back(file.filename().string());
  if (names.size() > kMaxNames) {
    names[kMaxNames - 2] = "...";
    names.erase(names.begin() + kMaxNames - 1, names.end() - 1);
  }
  raw->warnings.push_back(
      ros1 ? fmt::format("the bags of the folder are read as one recording: {}", fmt::join(names, ", "))
           : "the folder has no metadata.yaml; its bags were read in the order of their names");
  return raw;
}

Result<RawRecording> read_folder(const fs::path& folder, const Rig& rig, const Job& job,
                                 const ReadDetail& detail) {
  std::error_code error;
  const bool scans = fs::exists(folder / kScansCsv, error), motor = fs::exists(folder / kMotorCsv, error);
  if (scans && motor) return read_csv_recording(folder, rig, job);
  if (scans || motor) {
    return unreadable(fmt::format("{}: is a folder with {} and without {}", folder.string(),
                                  scans ? kScansCsv : kMotorCsv, scans ? kMotorCsv : kScansCsv));
  }
  if (is_bag_folder(folder)) return read_bag_folder(folder, rig, job, detail);
  return unreadable(fmt::format("{}: is a folder without a recording; {}", folder.string(), kReadable));
}

}  // namespace

Result<RawRecording> read_raw_recording(const fs::path& path, const Rig& rig, const Job& job,
                                        const ReadDetail& detail) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return read_folder(path, rig, job, detail);
  const auto start = beginning(path);
  if (!start) return tl::unexpected(start.error());
  const bool packed = begins_zstd(std::as_bytes(std::span(*start)));
  if (bag_storage(*start) || packed) return read_messages(path, {path}, rig, job, detail, true);
  return unreadable(fmt::format("{}: {}; {}", path.string(), not_readable(*start), kReadable));
}

std::vector<fs::path> recording_files(const fs::path& recording) {
  std::error_code ignored;
  std::vector<fs::path> named{recording};
  if (fs::is_directory(recording, ignored)) {
    named = bag_folder_files(recording);
    named.push_back(recording / kScansCsv);
    named.push_back(recording / kMotorCsv);
  }
  std::vector<fs::path> files;
  for (const fs::path& file : named)
    for (const char* of_database : {"", "-wal", "-shm", "-journal"})
      if (const fs::path path = file.string() + of_database; fs::exists(path, ignored)) files.push_back(path);
  return files;
}

std::uint64_t recording_size_bytes(const fs::path& recording) {
  std::uint64_t bytes = 0;
  std::error_code unknown;
  for (const fs::path& file : recording_files(recording))
    if (const std::uintmax_t size = fs::file_size(file, unknown); !unknown) bytes += size;
  return bytes;
}

}  // namespace sweepscope
