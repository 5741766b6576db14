#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/recording/formats/read_recording.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// A recording without ranges: the times of its scans and the motor's track, in a fraction of the memory. Of
/// scans that together have at most `max_beams` the ranges are read too, and those of clouds and CSV tables
/// always.
Result<Recording> read_outline(const std::filesystem::path& path, const ReadOptions& options,
                               std::size_t max_beams, const Job& job);

/// A recording's file, of which no more is read than is asked for. Its intensities are left out.
class RecordingFile {
 public:
  /// Reads the outline, and the ranges as well of scans that together have at most `max_beams`, 64 MiB.
  static Result<RecordingFile> open(std::filesystem::path path, ReadOptions options, const Job& job,
                                    std::size_t max_beams = std::size_t{1} << 24);
  /// A recording that was read as a whole.
  explicit RecordingFile(Recording whole) : outline_(std::move(whole)) {}

  /// All but the ranges, which are there if `is_whole`.
  const Recording& outline() const { return outline_; }
  /// What is known of the file beyond what reading found.
  ReadReport& report() { return outline_.report; }
  /// The outline is the whole recording.
  bool is_whole() const { return !outline_.ranges_m.empty() || outline_.scans.empty(); }

  /// The scans of some parts of the recording and its first and last scan: the result of parts_of without the
  /// memory for the whole. Seconds since the first scan.
  Result<Recording> parts(const std::vector<RecordingPart>& parts, const Job& job) const;
  /// All of it.
  Result<Recording> whole(const Job& job) const;

 private:
  std::filesystem::path path_;
  ReadOptions options_;
  Recording outline_;
};

}  // namespace sweepscope
