#pragma once

// The mathematics: docs/algorithms.md, section 1.

#include <vector>

#include "core/error.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/offset/prepared/candidates.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// How finely and how widely offsets are searched for one motor.
struct SearchScale {
  double unit_s =
      0;  // 1 ms, or more for a motor that turns less than 0.36 deg in it: what the data can resolve
  double half_width_s = 0;  // of the default window about 0
  /// Offsets that far to either side of 0 are told apart: half of MotorMotion::mirror_shift_s, which is a
  /// quarter of an even motor's period. Of a motor that turns one way a quarter of the offset by which its
  /// sides turn against each other by a whole turn.
  double max_half_width_s = 0;
};
SearchScale search_scale(const MotorMotion& motor);

/// Fails for ranges that together are wider than the motor allows, or that hold no candidate
/// (ExitCode::kWrongUsage).
Result<std::vector<double>> checked_offsets(const std::vector<OffsetRange>& ranges, const SearchScale& scale);

}  // namespace sweepscope
