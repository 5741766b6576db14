#include "core/offset/prepared/search_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

// The next 1, 2 or 5 times a power of ten.
double rounded_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (value <= factor * decade * (1 + 1e-9)) return factor * decade;
  return 10 * decade;
}

}  // namespace

SearchScale search_scale(const MotorMotion& motor) {
  SearchScale scale;
  scale.max_half_width_s =
      motor.one_way() ? std::numbers::pi / (2 * motor.speeds_apart_rad_s()) : motor.mirror_shift_s / 2;
  scale.unit_s = rounded_up(std::max(1e-3, 0.36 * kRadPerDeg / motor.lever_speed_rad_s()));
  scale.half_width_s =
      std::min(scale.max_half_width_s, std::max(0.060, 5 * kRadPerDeg / motor.lever_speed_rad_s()));
  return scale;
}

Result<std::vector<double>> checked_offsets(const std::vector<OffsetRange>& ranges,
                                            const SearchScale& scale) {
  for (const OffsetRange& range : ranges)
    if (!(range.step_s > 0) || !(range.from_s <= range.to_s))
      return failure(ExitCode::kWrongUsage, "A range of offsets needs FROM <= TO and a STEP above 0.");
  constexpr double kMaxCandidates = 100000;  // a day's work at a second each: a slip of the pen
  for (const OffsetRange& range : ranges)
    if ((range.to_s - range.from_s) / range.step_s > kMaxCandidates)
      return failure(ExitCode::kWrongUsage, "A range of offsets holds more than 100000 candidates.");
  const std::vector<double> offsets_s = offsets_of(ranges);
  if (offsets_s.empty()) return failure(ExitCode::kWrongUsage, "The ranges hold no candidate offset.");
  const double half_width_s = (offsets_s.back() - offsets_s.front()) / 2;
  if (half_width_s > scale.max_half_width_s + scale.unit_s / 2)  // sweeps are as long as an encoder shows
    return failure(
        ExitCode::kWrongUsage,
        fmt::format(
            "The range of offsets is {:.1f} ms to either side of its middle; this motor allows {:.1f} ms: "
            "offsets further apart than twice that give a perfect mirror image of each other.",
            half_width_s * 1e3, scale.max_half_width_s * 1e3));
  return offsets_s;
}

}  // namespace sweepscope
