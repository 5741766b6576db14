#include "core/map/criteria_about.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/estimator.hpp"

namespace sweepscope {
namespace {

// Eleven candidates or fewer of offsets that are near each other; at least two beyond them on either side.
double margin_ms_about(double apart_ms) {
  constexpr double kMin_ms = 2, kMax_ms = 5;
  return std::clamp(std::floor(kMax_ms - apart_ms / 2), kMin_ms, kMax_ms);
}

}  // namespace

Result<void> check_offset_count(std::size_t offsets) {
  if (offsets < 2 || offsets > 4)
    return failure(ExitCode::kWrongUsage,
                   "compare of a recording needs two to four offsets, such as --offsets-ms 19,24");
  return {};
}

Result<Estimate> criteria_about(const PreparedRecording& prepared, std::span<const OffsetMap> maps,
                                const KeptCandidates& kept, const Job& job) {
  const auto [first, last] = std::ranges::minmax_element(maps, {}, &OffsetMap::offset_s);
  EstimateOptions options;
  options.method = first->moving ? Method::kMoving : Method::kStationary;
  options.walk = first->walk;
  const double first_ms = first->offset_s * 1e3, last_ms = last->offset_s * 1e3,
               margin_ms = margin_ms_about(last_ms - first_ms);
  options.ranges = {{(first_ms - margin_ms) * 1e-3, (last_ms + margin_ms) * 1e-3, 1e-3}};
  auto found = estimate(prepared, options, kept, job);
  if (found && found->interrupted) return failure(ExitCode::kInterrupted, "interrupted");
  return found;
}

}  // namespace sweepscope
