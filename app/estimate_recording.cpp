#include "app/estimate_recording.hpp"

#include <cstdint>
#include <filesystem>

#include "core/offset/estimator.hpp"
#include "core/recording/formats/read_parts.hpp"
#include "core/recording/formats/read_raw_recording.hpp"

namespace sweepscope::app {
namespace {

bool is_large(const std::filesystem::path& recording) {
  constexpr std::uint64_t kLarge_bytes = std::uint64_t{64} << 20;
  return recording_size_bytes(recording) > kLarge_bytes;
}

DatedEstimate dated(Estimate estimate, const Recording& recording) {
  DatedEstimate result{std::move(estimate), {}};
  if (!recording.scans.empty())
    result.recorded_ns = recorded_ns(recording.epoch_ns, recording.scans.front().first_beam_s);
  return result;
}

}  // namespace

Result<std::optional<DatedEstimate>> estimate_from_parts(const RecordingOptions& input,
                                                         const EstimateOptions& search, const Job& job) {
  if (input.window || !is_large(input.recording)) return std::nullopt;
  const auto how = input.read_options();
  if (!how) return tl::unexpected(how.error());
  const auto outline = read_without_ranges(input.recording, *how, job);
  if (!outline) return tl::unexpected(outline.error());
  const auto parts = parts_of_estimate(*outline, search);
  if (!parts) return std::nullopt;
  const auto found =
      read_parts(input.recording, *how, *outline, *parts, job).and_then([&](const Recording& read) {
        return estimate_by_parts(read, search, job);
      });
  if (!found) return tl::unexpected(found.error());
  if (!*found) return std::nullopt;
  return dated(**found, *outline);
}

Result<DatedEstimate> estimate_recording(const RecordingOptions& input, const EstimateOptions& search,
                                         const Job& job) {
  auto from_parts = estimate_from_parts(input, search, job);
  if (!from_parts) return tl::unexpected(from_parts.error());
  if (*from_parts) return std::move(**from_parts);
  const auto recording = input.read(job);
  if (!recording) return tl::unexpected(recording.error());
  return estimate(*recording, search, job).map([&](Estimate&& found) {
    return dated(std::move(found), *recording);
  });
}

}  // namespace sweepscope::app
