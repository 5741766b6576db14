#pragma once

// The mathematics: docs/algorithms.md, section 16.

#include <array>
#include <optional>
#include <string>

#include "core/job.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/rig_solve/rig_least_squares.hpp"

namespace sweepscope {

/// What of a rig is solved for beside the offset, and how far it is thought to be from the rig file: standard
/// deviations. What no prior is given for has a wide one.
struct RigSolve {
  bool mount = false, play = false, encoder = false;
  double mount_deg = 20, mount_mm = 500, play_deg = 0.5, encoder_deg = 1;

  bool any() const { return mount || play || encoder; }
};

/// Whether the recording determines a part of the rig, and why not: a sentence.
struct RigFinding {
  bool solved = false;  // was to be solved for
  bool identifiable = false;
  std::string reason;
};

/// A rig as a recording shows it.
struct SolvedRig {
  Rig rig;  // the recording's, with what was found
  RigFinding mount, play, encoder;
  RigUnknowns found;     // about the recording's rig
  RigPriors priors;      // standard deviations; 0: not solved for
  RigMatrix covariance;  // of `found`
  /// What the parts of the rig that are solved for, and those that should be but are not identifiable, add to
  /// the offset's standard deviation.
  double offset_sigma_s = 0;
  double residual_before_m = 0, residual_after_m = 0;  // robust deviations from flat surfaces
  double unevenness_m = 0;                             // of walls, between parts of them
  std::size_t points = 0, surfaces = 0;
  bool converged = false;
  int iterations = 0;
};

/// Solves for the parts of a stationary rig, and the offset beside them, beginning at an offset near the
/// truth. What cannot be determined keeps the recording's value.
SolvedRig solve_rig(const OffsetProblem& problem, double first_offset_s, const RigSolve& what,
                    const Job& job);

/// The recording as the solved rig has it: mount and motor angles.
Recording with_rig(Recording recording, const SolvedRig& solved);

}  // namespace sweepscope
