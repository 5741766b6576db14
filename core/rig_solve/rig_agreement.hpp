#pragma once

// The mathematics: docs/rig.md.

#include <optional>
#include <vector>

#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// What one of several recordings of a rig says by itself, near the solution of all.
struct RigEvidence {
  bool converged = false;  // false: nothing, and it does not count below
  RigUnknowns found;
  RigMatrix covariance = RigMatrix::Zero();  // an unknown that it does not determine has its prior's variance
  RigUnknowns apart;                         // from what the others say together
  double residual_before_m = 0, residual_after_m = 0;  // robust deviation from its flat surfaces
};

/// Whether the recordings are of one rig: how they scatter about their weighted mean, in the unknowns that
/// they have in common.
struct RigAgreement {
  std::vector<RigEvidence> recordings;
  double chi_square = 0;
  int degrees_of_freedom = 0;  // 0: fewer than two recordings say anything by themselves
  /// The recording without which chi_square is least. Absent for fewer than three.
  std::optional<std::size_t> odd_one;
};

/// Solves each recording by itself, beginning at the solution of all of them.
RigAgreement agreement_of(RigRecordings recordings, const SolvedRig& solved, const Job& job);

}  // namespace sweepscope
