#pragma once

// The mathematics: docs/rig.md.

#include <initializer_list>
#include <span>

#include "core/job.hpp"
#include "core/rig_solve/rig_least_squares.hpp"

namespace sweepscope {

using RigRecordings = std::span<const OffsetProblem>;  // stationary recordings of one rig

/// The rig that was found, and the residuals before and after.
struct RigSolution {
  RigFit fit;                         // the values, sigmas and what is identifiable
  RigPriors priors;                   // that it was found with
  bool encoder_beyond_prior = false;  // and therefore held
};

/// Solves for the unknowns whose priors are not 0, from any start within 20 deg and 0.2 m. A mount without
/// its encoder is solved for with the rig file's encoder, unless the surfaces clearly show another. The
/// difference between the two enters the covariance, as do the scatter over time and with the size of cells.
RigSolution solution_of(RigRecordings recordings, const RigUnknowns& first, const RigPriors& priors,
                        const Job& job);

/// Options for a start within 0.03 m.
RigLeastSquaresOptions near_the_solution();

/// The fit with the scatter over time and with the size of cells in its covariance.
RigFit with_scatter(RigRecordings recordings, RigFit fit, const RigPriors& priors, const Job& job);

/// The set of cells changes between iterations, so that the last steps may oscillate; below sigma that is
/// accepted.
bool nearly_converged(const RigFit& fit);

/// A part is determined if its sigma is well below its prior.
bool determined(const RigFit& fit, const RigPriors& priors, std::initializer_list<RigUnknown> unknowns);

}  // namespace sweepscope
