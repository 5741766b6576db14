#pragma once

#include <filesystem>
#include <vector>

#include "core/recording/formats/read_recording.hpp"
#include "core/recording/recording_parts.hpp"

namespace sweepscope {

/// A recording without its beams' ranges: when each scan was made, and the motor's track. It takes a small
/// part of the memory. Of clouds and CSV tables the ranges are read all the same.
Result<Recording> read_without_ranges(const std::filesystem::path& path, const ReadOptions& options,
                                      const Job& job);

/// The scans of some parts of a recording, and its first and last one, as parts_of gives them of the whole,
/// but without the memory that the whole takes. `outline` is what read_without_ranges gave of the same file;
/// the parts are seconds since its first scan.
Result<Recording> read_parts(const std::filesystem::path& path, const ReadOptions& options,
                             const Recording& outline, const std::vector<RecordingPart>& parts,
                             const Job& job);

}  // namespace sweepscope
