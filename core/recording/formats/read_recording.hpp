#pragma once

#include <filesystem>
#include <optional>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// How to read a recording. The defaults detect everything.
struct ReadOptions {
  std::optional<Rig> rig;             // empty: everything is detected, and the motor rolls the laser about x
  std::optional<StampSource> stamps;  // for both streams, overrides the rig
  bool keep_intensities = true;       // false: only ReadReport::intensities says whether there are any
};

/// Reads a recording; the format is detected from the content, not from the file name: a ROS 1 bag, a ROS 2
/// bag (.db3, MCAP), or a folder of either or of CSV tables (read_raw_recording.hpp). Fails, with one
/// sentence that names the file and the place, if nothing in it can be used or if the choice of streams is
/// ambiguous.
Result<Recording> read_recording(const std::filesystem::path& path, const ReadOptions& options,
                                 const Job& job);

}  // namespace sweepscope
