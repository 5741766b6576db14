#include "app/estimate_recording.hpp"

#include <utility>

#include "core/offset/estimator.hpp"

namespace sweepscope::app {
namespace {

DatedEstimate dated(Estimate estimate, const Recording& recording) {
  DatedEstimate result{std::move(estimate), {}};
  if (!recording.scans.empty())
    result.recorded_ns = recorded_ns(recording.epoch_ns, recording.scans.front().first_beam_s);
  return result;
}

}  // namespace

Result<DatedEstimate> estimate_recording(const RecordingOptions& input, const EstimateOptions& search,
                                         const Job& job) {
  const auto file = input.open(job);
  if (!file) return tl::unexpected(file.error());
  return estimate(*file, search, job).map([&](Estimate&& found) {
    return dated(std::move(found), file->outline());
  });
}

}  // namespace sweepscope::app
