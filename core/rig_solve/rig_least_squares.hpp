#pragma once

// The mathematics: docs/algorithms.md, section 16.

#include <array>
#include <vector>

#include "core/job.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/rig_solve/rig_unknowns.hpp"
#include "core/rig_solve/surfaces.hpp"

namespace sweepscope {

/// Standard deviations about the rig file's values that each unknown is held with; 0: it is not solved for.
using RigPriors = RigVector;

struct RigLeastSquaresOptions {
  int max_iterations = 60;
  double first_loss_width_m = 0.2;
  double min_loss_width_m = 0.004;
  double loss_widths = 3;            // of the loss, in deviations of the residuals
  std::size_t max_points = 120'000;  // of more, every so many-th
  int max_levels = 4;
  double flatness = 0.5, reach = 1;  // of the loss's width
};

/// The rig in which flat surfaces are flattest.
struct RigFit {
  RigUnknowns rig;
  bool converged = false;
  int iterations = 0;
  RigVector last_step = RigVector::Zero();
  std::size_t points = 0, on_planes = 0, planes = 0;
  double residual_m = 0;                      // robust deviation of the distances from the planes
  double unevenness_m = 0;                    // by which parts of a wall deviate from its plane
  double first_residual_m = 0;                // the same with the rig file's values, on the same points
  RigMatrix covariance = RigMatrix::Zero();   // of the unknowns: what the points' noise, the priors and the
                                              // disagreement of parts of the scene leave
  RigMatrix information = RigMatrix::Zero();  // without priors
};

/// Solves for the offset and the parts of a stationary rig whose priors are not 0, beginning at `first`.
RigFit solve_rig_planes(const OffsetProblem& problem, const RigUnknowns& first, const RigPriors& priors,
                        const RigLeastSquaresOptions& options, const Job& job);

}  // namespace sweepscope
