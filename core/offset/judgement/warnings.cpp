#include "core/offset/judgement/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"

namespace sweepscope {

Remark aliased_warning(const Recording& recording, const MotorMotion& motor) {
  if (!sees_same_angles(recording, motor, motor.sweeps.size())) return std::nullopt;
  return fmt::format(
      "A sweep lasts almost exactly {:.0f} scans: every sweep measures at the same angles, and few surfaces "
      "are measured twice. A slightly slower or faster motor gives a better answer.",
      std::round(scans_a_sweep(recording, motor)));
}

Remark encoder_warning(const MotorTrack& track) {
  std::vector<double> spacings_s = spacings(track.time_s);
  const double median_s = median(spacings_s);
  if (spacings_s.size() < 4) return std::nullopt;
  std::sort(spacings_s.begin(), spacings_s.end());
  const double quartiles_s = spacings_s[3 * spacings_s.size() / 4] - spacings_s[spacings_s.size() / 4];
  const double jitter_s = quartiles_s / 1.349;  // as of a normal distribution
  if (jitter_s < 0.2 * median_s) return std::nullopt;
  return fmt::format("The encoder's samples are uneven: every {:.1f} ms +- {:.1f} ms.", median_s * 1e3,
                     jitter_s * 1e3);
}

Remark sampling_warning(const MotorTrack& track, const MotorMotion& motor) {
  constexpr double kFew = 8;  // below, 2 T n^-5 is more than 0.03 ms of a sweep of 0.5 s
  const double samples = samples_per_sweep(track, motor);
  if (samples > kFew) return std::nullopt;
  return fmt::format(
      "The motor is sampled only {:.1f} times per sweep: between samples its speed is assumed to be "
      "constant.",
      samples);
}

Remark slow_motor_warning(const MotorMotion& motor) {
  const double turned_deg = motor.lever_speed_rad_s() * 1e-3 / kRadPerDeg;
  if (turned_deg > 0.1) return std::nullopt;
  return fmt::format("The motor turns slowly: 1 ms is only {:.3f} deg here.", turned_deg);
}

Remark few_matches_warning(std::size_t matches, std::size_t features) {
  if (10 * matches > features) return std::nullopt;
  return fmt::format("Only {} of {} features were matched.", matches, features);
}

}  // namespace sweepscope
