#pragma once

#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

struct ReadOptions {
  std::optional<Rig> rig;             // else all is detected, and the motor rolls the laser about x
  std::optional<StampSource> stamps;  // for both streams, whatever the rig says
};

/// Reads a recording, told by its content and not by its name: a ROS 1 bag of format 2.0; a ROS 2 bag, as
/// one file (.db3 or MCAP) or as the folder that holds them; an MCAP file of ROS 1 messages; a folder of CSV
/// tables (csv_recording.hpp). Fails with one sentence that names the file and the place where nothing in it
/// can be used, or where what to use is not plain.
Result<Recording> read_recording(const std::filesystem::path& path, const ReadOptions& options,
                                 const Job& job);

/// What the file holds, before anything is chosen. What the rig rules out by name is counted and not kept.
Result<RawRecording> read_raw_recording(const std::filesystem::path& path, const Rig& rig, const Job& job);

}  // namespace sweepscope
