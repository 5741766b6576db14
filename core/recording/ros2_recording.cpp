#include "core/recording/ros2_recording.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/io/yaml_members.hpp"
#include "core/recording/input_file.hpp"
#include "core/recording/mcap_file.hpp"
#include "core/recording/message_collector.hpp"
#include "core/recording/sqlite_bag.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr std::uint64_t kMostMetadata_bytes = std::uint64_t{16} << 20;

/// "cdr" or "ros1"; messages of other encodings are only counted.
MessageCollector::Topic topic_of(const std::string& name, const std::string& type,
                                 const std::string& encoding, const std::string& md5sum) {
  const bool ros1 = encoding == "ros1", cdr = encoding == "cdr";
  return {name, type, cdr ? Encoding::kCdr : Encoding::kRos1, ros1 || cdr, ros1 ? md5sum : "*"};
}

Result<std::vector<std::string>> collect_mcap(const fs::path& path, MessageCollector& collector,
                                              const Job& job) {
  const auto visit = [&](const McapMessage& message) {
    const McapChannel& from = message.channel;
    const auto topic = topic_of(from.topic, from.type, from.encoding, from.md5sum);
    return collector.add(collector.number_of(topic), message.log_ns, message.bytes,
                         [&] { return message.place.text(); });
  };
  return read_mcap(path, visit, job);
}

Result<std::vector<std::string>> collect_sqlite(const fs::path& path, MessageCollector& collector,
                                                const Job& job) {
  const auto visit = [&](const SqliteMessage& message) {
    const SqliteTopic& from = message.topic;
    const auto topic = topic_of(from.name, from.type, from.encoding, "*");
    return collector.add(collector.number_of(topic), message.receive_ns, message.bytes,
                         [&] { return fmt::format("message {}", message.id); });
  };
  return read_sqlite_bag(path, visit, job);
}

std::optional<BagStorage> storage_of(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  auto file = InputFile::open(path);
  if (!file) return std::nullopt;
  std::string bytes(16, '\0');
  bytes.resize(file->read(std::as_writable_bytes(std::span(bytes))));
  return bag_storage(bytes);
}

/// Gives the warnings.
Result<std::vector<std::string>> collect(const fs::path& path, MessageCollector& collector, const Job& job) {
  const auto storage = storage_of(path);
  if (storage == BagStorage::kMcap) return collect_mcap(path, collector, job);
  if (storage == BagStorage::kSqlite) return collect_sqlite(path, collector, job);
  if (const auto file = InputFile::open(path); !file) return tl::unexpected(file.error());
  return unreadable(
      fmt::format("{}: byte 0 begins neither an SQLite database nor an MCAP file, as the files "
                  "of ROS 2 bags do",
                  path.string()));
}

/// The files that metadata.yaml names. Older recorders wrote the folder's name before a file's.
Result<std::vector<fs::path>> named_files(const fs::path& folder) {
  std::vector<fs::path> files;
  const auto read = [&](const YAML::Node& document) {
    const YAML::Node bag = document.IsMap() ? document["rosbag2_bagfile_information"] : YAML::Node();
    if (!bag || !bag.IsMap()) yaml::refuse(document, "there is no rosbag2_bagfile_information");
    if (const YAML::Node mode = bag["compression_mode"]; mode && mode.IsScalar() && !mode.Scalar().empty() &&
                                                         mode.Scalar() != "none" && mode.Scalar() != "NONE") {
      yaml::refuse(mode, fmt::format("the bag is compressed by {}, which is not read; decompress it with "
                                     "`ros2 bag convert`",
                                     mode.Scalar()));
    }
    const YAML::Node paths = bag["relative_file_paths"];
    if (!paths || !paths.IsSequence() || paths.size() == 0) yaml::refuse(bag, "it names no files");
    for (const YAML::Node& path : paths) {
      const fs::path name = fs::path(yaml::read_text(path, "a file of relative_file_paths")).filename();
      files.push_back(folder / name);
    }
  };
  return yaml::read_file(folder / kMetadata, "a ROS 2 bag's metadata", kMostMetadata_bytes, read).map([&] {
    return std::move(files);
  });
}

/// Those that are stored as bags are, by name.
std::vector<fs::path> found_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (storage_of(entry->path())) files.push_back(entry->path());
  std::ranges::sort(files);
  return files;
}

RawRecording named_recording(const fs::path& path) {
  RawRecording raw;
  raw.file = path.string();
  raw.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  return raw;
}

}  // namespace

std::optional<BagStorage> bag_storage(std::string_view beginning) {
  if (beginning.starts_with("\x89MCAP0\r\n")) return BagStorage::kMcap;
  if (beginning.starts_with(std::string_view("SQLite format 3\0", 16))) return BagStorage::kSqlite;
  return std::nullopt;
}

Result<RawRecording> read_ros2_file(const fs::path& path, const Rig& rig, const Job& job,
                                    CloudDetail clouds) {
  RawRecording raw = named_recording(path);
  MessageCollector collector(rig, raw, clouds);
  const auto damage = collect(path, collector, job);
  if (!damage) return tl::unexpected(damage.error());
  collector.finish();
  raw.warnings.insert(raw.warnings.begin(), damage->begin(), damage->end());
  return raw;
}

bool is_ros2_folder(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / kMetadata, ignored) || !found_files(folder).empty();
}

Result<RawRecording> read_ros2_folder(const fs::path& folder, const Rig& rig, const Job& job,
                                      CloudDetail clouds) {
  std::error_code ignored;
  const bool described = fs::exists(folder / kMetadata, ignored);
  const auto files = described ? named_files(folder) : found_files(folder);
  if (!files) return tl::unexpected(files.error());
  RawRecording raw = named_recording(folder);
  MessageCollector collector(rig, raw, clouds);
  std::vector<std::string> damages;
  for (const fs::path& file : *files) {
    const auto damage = collect(file, collector, job);
    if (!damage) return tl::unexpected(damage.error());
    for (const std::string& what : *damage)
      damages.push_back(fmt::format("{}: {}", file.filename().string(), what));
  }
  collector.finish();
  raw.warnings.insert(raw.warnings.begin(), damages.begin(), damages.end());
  if (!described)
    raw.warnings.insert(raw.warnings.begin(), "the folder has no metadata.yaml; its bags were read by name");
  return raw;
}

}  // namespace sweepscope
