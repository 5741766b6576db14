#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/read_detail.hpp"

namespace sweepscope {

/// Reads the content of a recording's file or folder, before streams are chosen: a ROS 1 bag of format 2.0; a
/// ROS 2 bag, as one file (.db3 or MCAP) or as the folder that holds them; an MCAP file of ROS 1 messages; a
/// folder of CSV tables (csv_recording.hpp). Streams that the rig excludes by name are counted and not kept.
Result<RawRecording> read_raw_recording(const std::filesystem::path& path, const Rig& rig, const Job& job,
                                        const ReadDetail& detail = {});

/// The files that a recording consists of, so that they are not overwritten: the file itself and, beside a
/// database, its journals; of a folder its CSV tables and, where it is a ROS 2 bag, metadata.yaml and every
/// file that is stored as one. Files that do not exist are not listed; only the first bytes of the files are
/// read.
std::vector<std::filesystem::path> recording_files(const std::filesystem::path& recording);

/// The size of these files together.
std::uint64_t recording_size_bytes(const std::filesystem::path& recording);

}  // namespace sweepscope
