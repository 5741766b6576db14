#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// What a recording's file or folder holds, before anything is chosen: a ROS 1 bag of format 2.0; a ROS 2
/// bag, as one file (.db3 or MCAP) or as the folder that holds them; an MCAP file of ROS 1 messages; a folder
/// of CSV tables (csv_recording.hpp). What the rig rules out by name is counted and not kept.
Result<RawRecording> read_raw_recording(const std::filesystem::path& path, const Rig& rig, const Job& job,
                                        CloudDetail clouds = CloudDetail::kLines);

}  // namespace sweepscope
