#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// The storage format of a file of a ROS 2 bag.
enum class BagStorage { kMcap, kSqlite };

/// Detected from a file's first 16 bytes; empty if it is neither.
std::optional<BagStorage> bag_storage(std::string_view beginning);

/// How a bag's file lies there.
struct StoredFile {
  BagStorage storage;
  bool packed;  // as a whole, by Zstandard
};
/// Told by its content; empty where it is no file of a ROS 2 bag.
std::optional<StoredFile> stored_as(const std::filesystem::path& path);

/// The files of a bag's folder in their order: those that metadata.yaml names; without one, all that are
/// stored as bags are, by name. Fails for files compressed by another format than zstd.
Result<std::vector<std::filesystem::path>> bag_files_of(const std::filesystem::path& folder);

/// Whether a folder has a description of its bag: metadata.yaml.
bool is_described(const std::filesystem::path& folder);
/// True where the folder is a ROS 2 bag's: it is described, or has files that are stored as one.
bool is_ros2_folder(const std::filesystem::path& folder);

/// The files of a bag's folder, whether they can be read or not: metadata.yaml, those that it names, and all
/// that are stored as a bag's are.
std::vector<std::filesystem::path> ros2_files(const std::filesystem::path& folder);

}  // namespace sweepscope
