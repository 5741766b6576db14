#pragma once

// The mathematics: docs/rig.md.

#include <optional>
#include <string>

#include "core/rig_solve/rig_least_squares.hpp"

namespace sweepscope {

/// How errors of the rig file's mount and encoder would show in the offset, and whether there are any.
struct RigCheck {
  /// Error of the offset per tilt of the mount, s per rad in the worst direction. Absent if too few flat
  /// surfaces are seen.
  std::optional<double> offset_per_tilt_s_rad;
  /// If another mount or an eccentric encoder fits clearly better: a sentence with the advice.
  std::optional<std::string> warning;
  /// Squared Mahalanobis distance of the best mount and encoder from the rig file's.
  double mount_evidence = 0, encoder_evidence = 0;
};

/// Checks the rig file of a stationary recording at its offset.
RigCheck check_rig(const OffsetProblem& problem, double offset_s, const Job& job);

}  // namespace sweepscope
