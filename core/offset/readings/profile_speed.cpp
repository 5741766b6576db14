#include "core/offset/readings/profile_speed.hpp"

#include <algorithm>
#include <cmath>

#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/search/stationary_fit.hpp"
#include "core/recording/assemble/motor_samples.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

constexpr double kFitting_m = 0.03;  // of sweeps at a speed that may be right

Recording turned_at(Recording recording, double turns_per_s) {
  recording.rig.motor.profile->turns_per_s = turns_per_s;
  turn_by_profile(recording);
  return recording;
}

// The stated speed first: of two that fit alike it is taken.
std::vector<double> speeds_to_try(const MotorProfile& profile) {
  constexpr double kStep = 0.004;
  std::vector<double> speeds{profile.turns_per_s};
  for (double away = kStep * profile.turns_per_s; away < profile.turns_per_s_within;
       away += kStep * profile.turns_per_s) {
    speeds.push_back(profile.turns_per_s - away);
    speeds.push_back(profile.turns_per_s + away);
  }
  return speeds;
}

// Of the first sweeps.
std::optional<double> best_speed(const Recording& first, const Job& job) {
  std::optional<double> best;
  double least_m = kFitting_m;
  for (const double speed : speeds_to_try(*first.rig.motor.profile)) {
    const StationaryFit fit = fit_stationary(turned_at(first, speed), job);
    if (job.cancelled()) return std::nullopt;
    if (!fit.fits || fit.direct.residual_m >= least_m) continue;
    least_m = fit.direct.residual_m;
    best = speed;
  }
  return best;
}

// Calls `use` with the grid of a part and the offset at which its sweeps fit best, unless they do not fit.
template <typename Use>
void at_best_offset(const Recording& part, const Job& job, const Use& use) {
  const StationaryFit fit = fit_stationary(part, job);
  if (!fit.fits || fit.direct.residual_m >= kFitting_m || job.cancelled()) return;
  const auto prepared = prepare(borrowed(part), FeatureOptions(), job);
  if (!prepared) return;
  const double offset_s = fit.direct.offset_s;
  use(stationary_grid(problem_for(*prepared, offset_s, offset_s)), offset_s);
}

// The drift of the offset over a part: the share by which the motor turns faster. Absent where sweeps do not
// fit.
std::optional<Trend> drift_of(const Recording& part, const Job& job) {
  std::optional<Trend> drift;
  at_best_offset(part, job, [&](const StationaryGrid& grid, double offset_s) {
    const StationaryDirect found = solve_stationary(grid, offset_s, StationaryDirectOptions(), job);
    drift = trend_of_blocks(found.block_s, found.block_offset_s, found.block_sigma_s);
  });
  return drift;
}

// At a wrong speed the sweeps turn as if the rig did.
bool looks_moving(const Recording& turned, const Job& job) {
  bool moving = true;
  at_best_offset(turned, job, [&](const StationaryGrid& grid, double offset_s) {
    moving = test_motion(grid, offset_s).moving();
  });
  return moving;
}

}  // namespace

std::optional<ProfileSpeed> find_profile_speed(const Recording& recording, const Job& job) {
  constexpr double kFirstSweeps = 9;
  constexpr int kCorrections = 3;  // of each part
  const MotorProfile& stated = *recording.rig.motor.profile;
  const double whole_s = recording.scans.back().first_beam_s - recording.scans.front().first_beam_s;
  double part_s = kFirstSweeps * stated.sweep_s();
  const auto first = best_speed(window(recording, 0, part_s), job);
  if (!first) return std::nullopt;
  ProfileSpeed found{*first, 0};
  for (bool whole = false; !whole; part_s *= 2) {
    whole = part_s >= whole_s;
    const Recording part = whole ? recording : window(recording, 0, part_s);
    for (int i = 0; i < kCorrections; ++i) {
      const auto drift = drift_of(turned_at(part, found.turns_per_s), job);
      if (!drift) return std::nullopt;
      found = {found.turns_per_s * (1 + drift->slope), found.turns_per_s * drift->sigma};
      if (std::abs(drift->slope) < drift->sigma) break;
    }
  }
  if (looks_moving(turned_at(recording, found.turns_per_s), job)) return std::nullopt;
  const bool inside = std::abs(found.turns_per_s - stated.turns_per_s) <=
                      stated.turns_per_s_within + 3 * found.sigma_turns_per_s;
  return inside ? std::optional(found) : std::nullopt;
}

}  // namespace sweepscope
