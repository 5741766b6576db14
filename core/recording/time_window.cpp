#include "core/recording/time_window.hpp"

#include <fmt/format.h>

namespace sweepscope {

Result<Recording> cut_to_window(const Recording& whole, const TimeWindow& part, const std::string& name) {
  Recording cut = window(whole, part.from_s, part.to_s);
  if (!cut.scans.empty()) return cut;
  const double last_s =
      whole.scans.empty() ? 0 : whole.scans.back().first_beam_s - whole.scans.front().first_beam_s;
  return failure(ExitCode::kWrongUsage,
                 fmt::format("{}: no scan lies between {} and {} s; the last one is at {:.3f} s", name,
                             part.from_s, part.to_s, last_s));
}

}  // namespace sweepscope
