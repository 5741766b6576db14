#include "core/recording/ros2/bag_files.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/io/input_file.hpp"
#include "core/io/yaml_members.hpp"
#include "core/recording/packed/decompress.hpp"
#include "core/recording/packed/unpacked_file.hpp"
#include "core/recording/ros1/ros1_record.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr std::uint64_t kMaxMetadata_bytes = std::uint64_t{16} << 20;

constexpr std::size_t kBeginning_bytes = 16;

/// The first bytes of what a packed file holds, of which `packed` is the beginning.
std::string unpacked_beginning(std::span<const std::byte> packed) {
  std::vector<std::byte> plain;
  const auto bytes = decompress(Compression::kZstd, packed, kBeginning_bytes, plain).bytes;
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
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

/// A name with its numbers filled up by zeros, so that part_2 comes before part_10.
std::string sorting_name(const fs::path& path) {
  constexpr std::size_t kDigits = 20;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::string name = path.filename().string();
  std::string filled;
  for (auto at = name.begin(); at != name.end();) {
    const auto end = std::find_if_not(at, name.end(), is_digit);
    const auto digits = static_cast<std::size_t>(end - at);
    if (digits > 0 && digits < kDigits) filled.append(kDigits - digits, '0');
    const auto next = digits > 0 ? end : at + 1;
    filled.append(at, next);
    at = next;
  }
  return filled;
}

/// Those that are stored as a ROS 2 bag is; without any the ROS 1 bags; by name.
std::vector<fs::path> found_files(const fs::path& folder) {
  std::vector<fs::path> ros1, ros2;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (const auto stored = stored_as(entry->path()))
      (stored->storage == BagStorage::kRos1 ? ros1 : ros2).push_back(entry->path());
  std::vector<fs::path>& files = ros2.empty() ? ros1 : ros2;
  std::ranges::sort(files, {}, [](const fs::path& path) { return std::pair(sorting_name(path), path); });
  return files;
}

}  // namespace

std::optional<BagStorage> bag_storage(std::string_view beginning) {
  if (beginning.starts_with(kBagMagic)) return BagStorage::kRos1;
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
  if (!storage || (packed && storage == BagStorage::kRos1)) return std::nullopt;
  return StoredFile{*storage, packed};
}

Result<std::vector<fs::path>> bag_files_of(const fs::path& folder) {
  return is_described(folder) ? named_files(folder) : found_files(folder);
}

bool is_described(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / kMetadata, ignored);
}

bool is_bag_folder(const fs::path& folder) {
  return is_described(folder) || !found_files(folder).empty();
}

std::vector<fs::path> bag_folder_files(const fs::path& folder) {
  std::vector<fs::path> files = found_files(folder);
  files.push_back(folder / kMetadata);
  if (const auto named = named_files(folder)) files.insert(files.end(), named->begin(), named->end());
  return files;
}

}  // namespace sweepscope
