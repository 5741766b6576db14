#pragma once

// The mathematics: docs/rig.md.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/job.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/rig_solve/rig_unknowns.hpp"
#include "core/rig_solve/surfaces.hpp"

namespace sweepscope {

/// Prior standard deviations of the unknowns about the rig file's values; 0: not solved for.
using RigPriors = RigVector;

/// Limits of the least squares, and the width of its loss.
struct RigLeastSquaresOptions {
  // A bound: the size of the step ends it, mostly after 8 to 24 iterations (tests/benchmark/rig_table). What
  // goes on for longer mostly oscillates between two sets of cells, however long.
  int max_iterations = 30;
  double first_loss_width_m = 0.2;   // what a mount 0.2 m wrong displaces a wall by
  double min_loss_width_m = 0.004;   // twice the least range noise, see estimate_range_noise_m
  double loss_widths = 3;            // width of the loss in deviations of the residuals
  std::size_t max_points = 120'000;  // of more points every n-th is used
  int max_levels = 4;                // of PlaneCellOptions: cells of at most 4 m
  double flatness = 0.5, reach = 1;  // in widths of the loss

  /// The width of the loss for residuals of this deviation.
  double loss_width_m(double residual_m) const {
    return std::max(min_loss_width_m, loss_widths * residual_m);
  }
};

/// The rig that makes flat surfaces flattest.
struct RigFit {
  RigUnknowns rig;         // where it ended
  bool converged = false;  // the last step was below the limit
  // False: the encoder lies further from the rig file's than its prior allows. Where hardly more than the
  // ground is in view, degrees of it and decimetres of a shift cancel.
  bool encoder_within_prior = true;
  int iterations = 0;                                 // Gauss-Newton steps taken
  RigVector last_step = RigVector::Zero();            // in the units of RigVector
  std::size_t points = 0, on_planes = 0, planes = 0;  // placed; those that lie on planes; the planes
  double residual_m = 0;                              // robust deviation of the distances from the planes
  double unevenness_m = 0;                            // deviation of the parts of a wall from its plane
  RigMatrix covariance = RigMatrix::Zero();   // of the unknowns, from noise, priors and the scatter of the
                                              // parts of the scene
  RigMatrix information = RigMatrix::Zero();  // without priors
  /// Of recordings with an offset each: by how much each offset follows the other unknowns, negative.
  std::vector<RigVector> offsets_follow;

  /// How far `count` unknowns from `first` on lie from 0, their rig file's values: the squared Mahalanobis
  /// distance.
  double squared_distance(RigUnknown first, int count) const;
};

/// How many points have one error in common: each comes from a line fitted to its neighbours.
double points_per_independent(const FeatureOptions& options);

/// Solves for the offset and the parts of a stationary rig whose priors are not 0, beginning at `first`, from
/// one recording of it or several: the information of each is added, with its own surfaces and noise. If
/// `first` has an offset for each recording, these are solved for instead of the offset of all.
RigFit solve_rig_planes(std::span<const OffsetProblem> recordings, const RigUnknowns& first,
                        const RigPriors& priors, const RigLeastSquaresOptions& options, const Job& job);

}  // namespace sweepscope
