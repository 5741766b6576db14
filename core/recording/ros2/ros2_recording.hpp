#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/read_detail.hpp"

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
/// stored as bags are, by name.
Result<std::vector<std::filesystem::path>> bag_files_of(const std::filesystem::path& folder);

/// The scans and joints of one file: an SQLite database as rosbag2 writes it, or an MCAP file, of ROS 2's
/// profile (cdr) or of ROS 1's (ros1); either also packed by zstd as a whole (rosbag2's compression mode
/// FILE) or message by message (MESSAGE). Those that the rig excludes by name are counted and not kept.
Result<RawRecording> read_ros2_file(const std::filesystem::path& path, const Rig& rig, const Job& job,
                                    const ReadDetail& detail = {});

/// True where the folder is a ROS 2 bag's: it has a metadata.yaml, or files that are stored as one.
bool is_ros2_folder(const std::filesystem::path& folder);

/// The files of a bag's folder, whether they can be read or not: metadata.yaml, those that it names, and all
/// that are stored as a bag's are.
std::vector<std::filesystem::path> ros2_files(const std::filesystem::path& folder);

/// A bag's folder: the files that its metadata.yaml names, in that order; without one, all that are bags, by
/// name. Fails for files compressed by another format than zstd.
Result<RawRecording> read_ros2_folder(const std::filesystem::path& folder, const Rig& rig, const Job& job,
                                      const ReadDetail& detail = {});

}  // namespace sweepscope
