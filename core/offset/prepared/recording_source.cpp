#include "core/offset/prepared/recording_source.hpp"

#include <utility>

namespace sweepscope {

Result<std::shared_ptr<const Recording>> RecordingSource::read(const std::vector<RecordingPart>& parts,
                                                               const Job& job) const {
  if (whole_) return whole_;
  auto recording = parts.empty() ? file_->whole(job) : file_->parts(parts, job);
  return std::move(recording).map([](Recording&& read) -> std::shared_ptr<const Recording> {
    return std::make_shared<const Recording>(std::move(read));
  });
}

Result<PreparedRecording> RecordingSource::prepare(std::shared_ptr<const Recording> read,
                                                   const FeatureOptions& options, const Job& job) const {
  if (prepared_ != nullptr && read == prepared_->recording) return *prepared_;
  return sweepscope::prepare(std::move(read), options, job);
}

}  // namespace sweepscope
