#include "core/rig_solve/rig_check.hpp"

#include <fmt/format.h>

#include "core/numbers.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {
namespace {

// Four planes are the fewest that determine four unknowns of a mount and two of an encoder.
constexpr std::size_t kMinPoints = 1000, kMinSurfaces = 4;

}  // namespace

RigCheck check_rig(const OffsetProblem& problem, double offset_s, const Job& job) {
  // Squared Mahalanobis distances above those of perfect rigs, far above the quantiles of a normal
  // distribution since the covariance comes from a dozen parts of the scene. Chosen with
  // tests/benchmark/rig_table (its families without a part to solve for).
  constexpr double kMaxMount = 150, kMaxEncoder = 30;
  RigCheck check;
  RigUnknowns first;
  first.offset_s = offset_s;
  const RigPriors priors = priors_of({.mount = true, .encoder = true});
  RigLeastSquaresOptions options;
  options.max_points = 12'000;
  options.max_iterations = 20;
  RigFit fit = solve_rig_planes({&problem, 1}, first, priors, options, job);
  if (!fit.encoder_within_prior)
    fit = solve_rig_planes({&problem, 1}, first, priors_of({.mount = true}), options, job);
  if (job.cancelled() || fit.on_planes < kMinPoints || fit.planes < kMinSurfaces) return check;
  if (!(fit.information(kOffset, kOffset) > 0)) return check;
  check.offset_per_tilt_s_rad =
      fit.information.block<1, 2>(kOffset, kTurnU).norm() / fit.information(kOffset, kOffset);
  if (!fit.converged) return check;
  check.mount_evidence = fit.squared_distance(kTurnU, 4);
  if (fit.covariance(kEncoderSine, kEncoderSine) > 0)
    check.encoder_evidence = fit.squared_distance(kEncoderSine, 2);
  if (check.mount_evidence > kMaxMount)
    check.warning = fmt::format(
        "Surfaces are flatter with another mount: the laser turned by {:.2f} deg and moved by {:.0f} mm. "
        "Solve for the mount (--solve offset,mount).",
        fit.rig.turn_rad.norm() * kDegPerRad, fit.rig.shift_m.norm() * 1e3);
  else if (check.encoder_evidence > kMaxEncoder)
    check.warning = fmt::format(
        "Surfaces are flatter with an eccentric encoder, by {:.2f} deg. Solve for the encoder (--solve "
        "offset,encoder).",
        fit.rig.encoder_rad.norm() * kDegPerRad);
  return check;
}

}  // namespace sweepscope
