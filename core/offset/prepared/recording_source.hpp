#pragma once

#include <memory>
#include <vector>

#include "core/offset/prepared/prepared.hpp"
#include "core/recording/formats/recording_file.hpp"

namespace sweepscope {

/// The recording of an estimate, in memory or in a file that is read as far as the estimate goes by it. What
/// it is made of must outlive it.
class RecordingSource {
 public:
  /// A recording in memory.
  RecordingSource(const Recording& whole) : whole_(borrowed(whole)) {}
  /// A recording in memory with its features.
  RecordingSource(const PreparedRecording& whole) : whole_(whole.recording), prepared_(&whole) {}
  /// A recording in a file.
  RecordingSource(const RecordingFile& file) : file_(&file) {
    if (file.is_whole()) whole_ = borrowed(file.outline());
  }

  /// All but the ranges.
  const Recording& outline() const { return whole_ ? *whole_ : file_->outline(); }
  /// A recording that holds at least these parts, in seconds since the first scan; no parts: all of it.
  /// Errors are those of reading.
  Result<std::shared_ptr<const Recording>> read(const std::vector<RecordingPart>& parts,
                                                const Job& job) const;
  /// The features of a recording that `read` gave, which are not computed again if the source has them.
  Result<PreparedRecording> prepare(std::shared_ptr<const Recording> read, const FeatureOptions& options,
                                    const Job& job) const;

 private:
  std::shared_ptr<const Recording> whole_;  // null: in the file only
  const PreparedRecording* prepared_ = nullptr;
  const RecordingFile* file_ = nullptr;
};

}  // namespace sweepscope
