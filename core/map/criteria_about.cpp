#include "core/map/criteria_about.hpp"

#include <algorithm>

#include "core/offset/estimator.hpp"

namespace sweepscope {

Result<void> check_offset_count(std::size_t offsets) {
  if (offsets < 2 || offsets > 4)
    return failure(ExitCode::kWrongUsage,
                   "compare of a recording needs two to four offsets, such as --offsets-ms 19,24");
  return {};
}

Result<Estimate> criteria_about(const PreparedRecording& prepared, std::span<const OffsetMap> maps,
                                const KeptCandidates& kept, const Job& job) {
  constexpr double kMargin_ms = 5;
  const auto [first, last] = std::ranges::minmax_element(maps, {}, &OffsetMap::offset_s);
  EstimateOptions options;
  options.method = first->moving ? Method::kMoving : Method::kStationary;
  options.walk = first->walk;
  options.ranges = {
      {(first->offset_s * 1e3 - kMargin_ms) * 1e-3, (last->offset_s * 1e3 + kMargin_ms) * 1e-3, 1e-3}};
  auto found = estimate(prepared, options, kept, job);
  if (found && found->interrupted) return failure(ExitCode::kInterrupted, "interrupted");
  return found;
}

}  // namespace sweepscope
