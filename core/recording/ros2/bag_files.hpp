#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

/// The format of a file of messages: a ROS 1 bag, or how a ROS 2 bag is stored.
enum class BagStorage { kRos1, kMcap, kSqlite };

/// Detected from a file's first 16 bytes; empty if it is none of these.
std::optional<BagStorage> bag_storage(std::string_view beginning);

/// How a bag's file lies there.
struct StoredFile {
  BagStorage storage;
  bool packed;  // as a whole, by Zstandard, as those of ROS 2 bags may be
};
/// Detected from its content; empty where it is no file of a bag.
std::optional<StoredFile> stored_as(const std::filesystem::path& path);

/// The files of a bag's folder in their order: those that metadata.yaml names; without one, all that are
/// stored as a ROS 2 bag, else all ROS 1 bags, by name (part_2 before part_10). Fails for files compressed by
/// another format than zstd.
Result<std::vector<std::filesystem::path>> bag_files_of(const std::filesystem::path& folder);

/// Whether a folder has a description of its bag: metadata.yaml.
bool is_described(const std::filesystem::path& folder);
/// True where the folder is described, or has files that are stored as bags.
bool is_bag_folder(const std::filesystem::path& folder);

/// The files of a bag's folder, whether they can be read or not: metadata.yaml, those that it names, and all
/// that are stored as a bag's are.
std::vector<std::filesystem::path> bag_folder_files(const std::filesystem::path& folder);

}  // namespace sweepscope
