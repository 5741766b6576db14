#pragma once

// The mathematics: docs/rig.md.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/job.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/rig_solve/rig_least_squares.hpp"
#include "core/rig_solve/rig_residuals.hpp"
#include "core/rig_solve/rig_solution.hpp"
#include "core/rig_solve/walk_turn.hpp"

namespace sweepscope {

/// The parts of the rig to solve for beside the offset, and the prior standard deviations of their distance
/// from the rig file.
struct RigSolve {
  bool mount = false, play = false, encoder = false;  // whether each is solved for
  /// 1 sigma of the priors about the values given.
  /// 1 sigma of the priors about the values given.
  double mount_deg = 20, mount_mm = 500, play_deg = 0.5, encoder_deg = 1;
  bool offset = true;  // false: it stays where it is, as where a motor turns one way at one speed

  /// Whether anything beside the offset is solved for.
  bool any() const { return mount || play || encoder; }
};

/// The same as priors of the unknowns.
RigPriors priors_of(const RigSolve& what);

/// Whether the recording determines a part of the rig, and if not, the reason: a sentence.
struct RigFinding {
  bool solved = false;        // requested
  bool identifiable = false;  // the recording determines it
  std::string reason;         // why not; else empty
};

/// The rig found from a recording.
struct SolvedRig {
  // Of a walk: the turn of the mount is all that is determined, and the residuals are distances per match.
  bool along_walk = false;
  Rig given;                                 // the recording's
  Rig rig;                                   // the same with what was found
  RigFinding mount, play, encoder;           // of each part that was solved for
  RigUnknowns found;                         // about the recording's rig
  RigUnknowns before;                        // the offset alone, with the rig as given
  RigPriors priors;                          // standard deviations; 0: not solved for
  RigMatrix covariance = RigMatrix::Zero();  // of `found`
  /// Contribution of the requested parts of the rig to the standard deviation of the offset, identifiable or
  /// not.
  double offset_sigma_s = 0;
  std::vector<double> own_offset_sigma_s;              // the same of recordings with an offset each
  double residual_before_m = 0, residual_after_m = 0;  // robust deviation from flat surfaces
  double unevenness_m = 0;                             // deviation of the parts of a wall from its plane
  RigResiduals residuals;  // over the motor's angle and the beam; of several recordings the first's
  std::size_t points = 0, surfaces = 0;  // that the answer rests on
  bool converged = false;                // the last step was below the limit
  int iterations = 0;                    // Gauss-Newton steps taken
};

/// Solves for the offset and the requested parts of a stationary rig, beginning near the true offset; from
/// several recordings together, whose rig files are the same, as solve_rig_planes. Parts that are not
/// determined keep the value of the rig file.
SolvedRig solve_rig(RigRecordings recordings, const RigUnknowns& first, const RigSolve& what, const Job& job);

/// The rig with the turn of its mount as a walk shows it, from the given rig on, and the priors taken into
/// account. The mount's shift, gear play and encoder are not determined from a walk.
SolvedRig rig_of_walk(const OffsetProblem& problem, const WalkTurn& turn, const RigSolve& what);

/// The recording with the mount and the motor angles of the solved rig.
Recording with_rig(Recording recording, const SolvedRig& solved);

}  // namespace sweepscope
