#pragma once

#include <filesystem>
#include <vector>

#include "core/recording/formats/read_recording.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// A recording without ranges: the times of its scans and the motor's track, in a fraction of the memory. For
/// clouds and CSV tables the ranges are read too.
Result<Recording> read_without_ranges(const std::filesystem::path& path, const ReadOptions& options,
                                      const Job& job);

/// The scans of some parts of a recording and its first and last scan: the result of parts_of without the
/// memory for the whole. `outline` is the result of read_without_ranges for the same file; the parts are in
/// seconds since its first scan.
Result<Recording> read_parts(const std::filesystem::path& path, const ReadOptions& options,
                             const Recording& outline, const std::vector<RecordingPart>& parts,
                             const Job& job);

}  // namespace sweepscope
