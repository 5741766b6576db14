#pragma once

// The mathematics: docs/algorithms.md, section 16.

#include <optional>
#include <string>

#include "core/rig_solve/rig_least_squares.hpp"

namespace sweepscope {

/// What an offset found with the rig file's mount and encoder leaves open.
struct RigCheck {
  /// By how much the offset errs where the mount is tilted, s per rad in the worst direction. Absent where
  /// too few flat surfaces are seen.
  std::optional<double> offset_per_tilt_s_rad;
  /// Where another mount or an eccentric encoder fits clearly better, what to do: a sentence.
  std::optional<std::string> warning;
  /// Squared distance of the best mount and encoder from the rig file's, in standard deviations.
  double mount_evidence = 0, encoder_evidence = 0;
};

/// Of a stationary rig, at its offset. A perfect rig is warned about in fewer than one of a hundred
/// recordings: see kMaxMount in rig_check.cpp.
RigCheck check_rig(const OffsetProblem& problem, double offset_s, const Job& job);

}  // namespace sweepscope
