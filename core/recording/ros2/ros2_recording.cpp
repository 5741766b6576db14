#include "core/recording/ros2/ros2_recording.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/io/input_file.hpp"
#include "core/io/yaml_members.hpp"
#include "core/recording/messages/message_collector.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/packed/unpacked_file.hpp"
#include "core/recording/ros2/mcap_file.hpp"
#include "core/recording/ros2/sqlite_bag.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr std::uint64_t kMaxMetadata_bytes = std::uint64_t{16} << 20;

/// "cdr" or "ros1"; messages of other encodings are only counted.
MessageCollector::Topic topic_of(const std::string& name, const std::string& type,
                                 const std::string& encoding, const std::string& md5sum) {
  const bool ros1 = encoding == "ros1", cdr = encoding == "cdr";
  return {name, type, cdr ? Encoding::kCdr : Encoding::kRos1, ros1 || cdr, ros1 ? md5sum : "*"};
}

Result<std::vector<std::string>> collect_mcap(const fs::path& path, UnpackingLimit& limit,
                                              MessageCollector& collector, const Job& job) {
  const auto visit = [&](const McapMessage& message) {
    const McapChannel& from = message.channel;
    const auto topic = topic_of(from.topic, from.type, from.encoding, from.md5sum);
    return collector.add(collector.number_of(topic), message.log_ns, message.bytes,
                         [&] { return message.place.text(); });
  };
  return read_mcap(path, limit, visit, job);
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

constexpr std::size_t kBeginning_bytes = 16;

/// The first bytes of what a packed file holds, of which `packed` is the beginning.
std::string unpacked_beginning(std::span<const std::byte> packed) {
  std::vector<std::byte> plain;
  const auto bytes = decompress(Compression::kZstd, packed, kBeginning_bytes, plain).bytes;
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<std::vector<std::string>> collect_as(BagStorage storage, const fs::path& path, UnpackingLimit& limit,
                                            MessageCollector& collector, const Job& job) {
  collector.begin_file(limit);
  return storage == BagStorage::kMcap ? collect_mcap(path, limit, collector, job)
                                      : collect_sqlite(path, collector, job);
}

/// What a sentence says of `file`, said of `other`.
std::string renamed(std::string sentence, const fs::path& file, const fs::path& other) {
  const std::string name = file.string();
  for (std::size_t at = 0; (at = sentence.find(name, at)) != std::string::npos; at += other.string().size())
    sentence.replace(at, name.size(), other.string());
  return sentence;
}

Result<std::vector<std::string>> collect_packed(BagStorage storage, const fs::path& path,
                                                UnpackingLimit& limit, MessageCollector& collector,
                                                const Job& job) {
  const auto unpacked = UnpackedFile::unpack(path, limit, job);
  if (!unpacked) return tl::unexpected(unpacked.error());
  auto damage = collect_as(storage, unpacked->path(), limit, collector, job);
  if (!damage) return failure(damage.error().code, renamed(damage.error().message, unpacked->path(), path));
  for (std::string& what : *damage) what = renamed(what, unpacked->path(), path);
  if (!unpacked->problem().empty()) damage->push_back(unpacked->problem());
  return damage;
}

/// Gives the warnings.
Result<std::vector<std::string>> collect(const fs::path& path, MessageCollector& collector, const Job& job) {
  if (const auto stored = stored_as(path)) {
    UnpackingLimit limit(path);
    return stored->packed ? collect_packed(stored->storage, path, limit, collector, job)
                          : collect_as(stored->storage, path, limit, collector, job);
  }
  if (const auto file = InputFile::open(path); !file) return tl::unexpected(file.error());
  return unreadable(
      fmt::format("{}: byte 0 begins neither an SQLite database nor an MCAP file, as the files of ROS 2 bags "
                  "do, nor one that is packed by zstd",
                  path.string()));
}

/// The files that metadata.yaml names. Older recorders wrote the folder's name before a file's.
Result<std::vector<fs::path>> named_files(const fs::path& folder) {
  std::vector<fs::path> files;
  const auto read = [&](const YAML::Node& document) {
    const YAML::Node bag = document.IsMap() ? document["rosbag2_bagfile_information"] : YAML::Node();
    if (!bag || !bag.IsMap()) yaml::refuse(document, "there is no rosbag2_bagfile_information");
    if (const YAML::Node packed = bag["compression_format"];
        packed && packed.IsScalar() && !packed.Scalar().empty() && packed.Scalar() != "none" &&
        packed.Scalar() != "zstd") {
      yaml::refuse(packed, fmt::format("the bag is compressed as {}, and only zstd is supported; decompress "
                                       "it with `ros2 bag convert`",
                                       packed.Scalar()));
    }
    const YAML::Node paths = bag["relative_file_paths"];
    if (!paths || !paths.IsSequence() || paths.size() == 0) yaml::refuse(bag, "it names no files");
    for (const YAML::Node& path : paths) {
      const fs::path name = fs::path(yaml::read_text(path, "a file of relative_file_paths")).filename();
      files.push_back(folder / name);
    }
  };
  return yaml::read_file(folder / kMetadata, "a ROS 2 bag's metadata", kMaxMetadata_bytes, read).map([&] {
    return std::move(files);
  });
}

/// Those that are stored as bags are, by name.
std::vector<fs::path> found_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (stored_as(entry->path())) files.push_back(entry->path());
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

std::optional<StoredFile> stored_as(const fs::path& path) {
  constexpr std::size_t kMaxZstdBlock_bytes = std::size_t{1} << 18;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  auto file = InputFile::open(path);
  if (!file) return std::nullopt;
  std::vector<std::byte> bytes(kBeginning_bytes);
  bytes.resize(file->read(bytes));
  const bool packed = begins_zstd(bytes);
  if (packed) {
    file->seek(0);
    bytes.resize(kMaxZstdBlock_bytes);
    bytes.resize(file->read(bytes));
  }
  const auto storage =
      bag_storage(packed ? unpacked_beginning(bytes)
                         : std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  if (!storage) return std::nullopt;
  return StoredFile{*storage, packed};
}

Result<std::vector<fs::path>> bag_files_of(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / kMetadata, ignored)) return named_files(folder);
  return found_files(folder);
}

Result<RawRecording> read_ros2_file(const fs::path& path, const Rig& rig, const Job& job,
                                    const ReadDetail& detail) {
  RawRecording raw = named_recording(path);
  MessageCollector collector(rig, raw, detail);
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

std::vector<fs::path> ros2_files(const fs::path& folder) {
  std::vector<fs::path> files = found_files(folder);
  files.push_back(folder / kMetadata);
  if (const auto named = named_files(folder)) files.insert(files.end(), named->begin(), named->end());
  return files;
}

Result<RawRecording> read_ros2_folder(const fs::path& folder, const Rig& rig, const Job& job,
                                      const ReadDetail& detail) {
  std::error_code ignored;
  const bool described = fs::exists(folder / kMetadata, ignored);
  const auto files = bag_files_of(folder);
  if (!files) return tl::unexpected(files.error());
  RawRecording raw = named_recording(folder);
  MessageCollector collector(rig, raw, detail);
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
    raw.warnings.insert(raw.warnings.begin(),
                        "the folder has no metadata.yaml; its bags were read in the order of their names");
  return raw;
}

}  // namespace sweepscope
