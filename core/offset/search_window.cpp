#include "core/offset/search_window.hpp"

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
      motor.one_way() ? std::numbers::pi / (2 * motor.speeds_apart_rad_s()) : motor.median_sweep_s / 2;
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
  if (half_width_s > scale.max_half_width_s + 1e-9)
    return failure(
        ExitCode::kWrongUsage,
        fmt::format(
            "The range of offsets is {:.1f} ms to either side of its middle; this motor allows {:.1f} ms, a "
            "quarter of its period: an offset wrong by one sweep gives a perfect mirror image.",
            half_width_s * 1e3, scale.max_half_width_s * 1e3));
  return offsets_s;
}

std::vector<std::string> motor_reasons(const MotorTrack& track, const MotorMotion& motor) {
  if (track.time_s.size() < 3) return {fmt::format("The motor has only {} samples.", track.time_s.size())};
  if (motor.sweeps.empty())
    return {fmt::format("The motor does not move: its angle stays within {:.2f} deg.",
                        motor.range_rad / kRadPerDeg)};
  // Slower changes of speed than this are no two speeds: the motor's own unevenness, or the encoder's.
  constexpr double kMinSpeedChange = 0.1;
  const bool one_speed = motor.speeds_apart_rad_s() < kMinSpeedChange * motor.median_speed_rad_s;
  if (motor.sweeps.size() < 2 || (motor.one_way() && one_speed))
    return {fmt::format(
        "The motor turns one way only, at one speed ({:.0f} deg in {:.1f} s): an offset cannot be "
        "distinguished from the encoder's zero. Record 5 s at one speed and 5 s at half of it.",
        motor.range_rad / kRadPerDeg, track.time_s.back() - track.time_s.front())};
  return {};
}

std::vector<std::string> one_way_reasons(const MotorMotion& motor, RigKind kind, Method method) {
  if (!motor.one_way()) return {};
  if (method != Method::kDirect)
    return {
        "The paper's criteria compare sweeps of opposite directions, and this motor turns one way. Use the "
        "direct method (--method direct)."};
  if (kind == RigKind::kMoving)
    return {
        "The rig moved, and its motor turns one way: an offset then looks like a rotation of the rig about "
        "the motor's axis. Record 5 s at one speed and 5 s at half of it while the rig is stationary."};
  return {};
}

}  // namespace sweepscope
