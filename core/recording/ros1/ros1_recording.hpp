#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/read_detail.hpp"

namespace sweepscope {

/// The scans and joints of a ROS 1 bag. Those that the rig excludes by name are counted and not kept.
Result<RawRecording> read_ros1_recording(const std::filesystem::path& path, const Rig& rig, const Job& job,
                                         const ReadDetail& detail = {});

}  // namespace sweepscope
