#include "core/rig_solve/rig_solution.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/recording/sweeps.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

// Priors with those of a usual encoder, for a mount that is solved for without it: both bend walls in the
// same way.
RigPriors with_usual_encoder(RigPriors priors) {
  constexpr double kUsual_deg = 0.3;  // a disc of 40 mm that sits 0.1 mm off its centre
  if (priors[kTurnU] > 0 && priors[kEncoderSine] == 0)
    priors[kEncoderSine] = priors[kEncoderCosine] = kUsual_deg * kRadPerDeg;
  return priors;
}

// If the fit did not converge, it is repeated from other shifts. The best is one that converged, and among
// those the one with most points per surface: a wrong rig splits walls in two.
RigFit solved_from_around(RigRecordings recordings, RigFit fit, const RigPriors& priors, const Job& job) {
  constexpr double kApart_m = 0.15;  // within the 0.2 m that a start may be wrong by
  const RigUnknowns begun = fit.rig;
  const auto goodness = [](const RigFit& a) {
    return std::pair(a.converged, double(a.on_planes) / double(std::max<std::size_t>(1, a.planes)));
  };
  for (const auto& shift_m : {Eigen::Vector2d(kApart_m, 0.0), Eigen::Vector2d(-kApart_m, 0.0),
                              Eigen::Vector2d(0.0, kApart_m), Eigen::Vector2d(0.0, -kApart_m)}) {
    RigUnknowns first = begun;
    first.shift_m = shift_m;
    const RigFit other = solve_rig_planes(recordings, first, priors, {}, job);
    if (goodness(other) > goodness(fit)) fit = other;
  }
  return fit;
}

std::size_t fewest_sweeps(RigRecordings recordings) {
  std::size_t fewest = SIZE_MAX;
  for (const OffsetProblem& problem : recordings) fewest = std::min(fewest, problem.motor.sweeps.size());
  return fewest;
}

// Leaves out the scans of other groups of pairs of sweeps.
void use_group(OffsetProblem& problem, double offset_s, std::size_t group, std::size_t groups) {
  const auto sweep_of = assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s);
  for (std::size_t i = 0; i < sweep_of.size(); ++i)
    if (sweep_of[i] == kNoSweep || sweep_of[i] / 2 % groups != group) problem.scan_used[i] = 0;
}

// The scatter of the solutions of groups of sweeps. Errors of whole scans, such as those of their stamps, are
// the same on all surfaces, and do not show when parts of the scene are left out.
RigMatrix scatter_over_time(RigRecordings recordings, const RigFit& fit, const RigPriors& priors,
                            const RigLeastSquaresOptions& options, const Job& job) {
  constexpr std::size_t kGroups = 4;  // of pairs of sweeps, one of each direction: 2 pairs each in 8 s
  std::vector<RigVector> found;
  for (std::size_t group = 0; group < kGroups && fewest_sweeps(recordings) >= 2 * kGroups; ++group) {
    std::vector<OffsetProblem> part(recordings.begin(), recordings.end());
    for (std::size_t i = 0; i < part.size(); ++i)
      use_group(part[i], fit.rig.of_recording(i).offset_s, group, kGroups);
    const RigFit by_itself = solve_rig_planes(part, fit.rig, priors, options, job);
    if (nearly_converged(by_itself)) found.push_back(by_itself.rig.vector());
  }
  RigMatrix sum = RigMatrix::Zero();
  if (found.size() < 3) return sum;
  const auto n = double(found.size());
  RigVector mean = RigVector::Zero();
  for (const RigVector& x : found) mean += x / n;
  for (const RigVector& x : found) sum += (x - mean) * (x - mean).transpose();
  const double factor = student_factor(n - 1);
  return sum / (n * (n - 1)) * factor * factor;
}

RigMatrix square(const RigVector& x) {
  return x * x.transpose();
}

RigPriors without_encoder(RigPriors priors) {
  priors[kEncoderSine] = priors[kEncoderCosine] = 0;
  return priors;
}

// Bent walls look like a wrong rig, and more so in larger cells: the change of the solution with smaller
// cells. An encoder that these do not determine is not changed.
RigMatrix changes_by_smaller_cells(RigRecordings recordings, const RigFit& fit, const RigPriors& priors,
                                   const Job& job) {
  RigLeastSquaresOptions smaller = near_the_solution();
  RigUnknowns first = fit.rig;
  first.encoder_rad.setZero();
  RigMatrix sum = RigMatrix::Zero();
  for (const int levels : {2, 1}) {  // cells of at most 1 m and 0.5 m instead of 4 m
    smaller.max_levels = levels;
    RigFit other = solve_rig_planes(recordings, first, priors, smaller, job);
    if (!other.encoder_within_prior)
      other = solve_rig_planes(recordings, fit.rig, without_encoder(priors), smaller, job);
    sum += square(other.rig.vector() - fit.rig.vector());
  }
  return sum;
}

// Whether the surfaces show an eccentric encoder that is not asked for. Perfect ones of
// tests/benchmark/rig_table do not.
bool shows_encoder(const RigFit& fit, const RigPriors& priors) {
  constexpr double kMaxSquaredDistance = 60;
  return determined(fit, priors, {kEncoderSine, kEncoderCosine}) &&
         fit.squared_distance(kEncoderSine, 2) > kMaxSquaredDistance;
}

// The covariance of a fit without the encoder, for an encoder that may be off by its prior: the rest follows
// it as the surfaces require.
RigMatrix covariance_with_encoder(const RigFit& fit, const RigPriors& priors) {
  std::vector<int> rest;
  for (int i = 0; i < kEncoderSine; ++i)
    if (priors[i] > 0) rest.push_back(i);
  const std::vector<int> encoder{kEncoderSine, kEncoderCosine};
  Eigen::MatrixXd of_rest = fit.information(rest, rest);
  for (std::size_t i = 0; i < rest.size(); ++i)
    of_rest(Eigen::Index(i), Eigen::Index(i)) += 1 / (priors[rest[i]] * priors[rest[i]]);
  const Eigen::MatrixXd follows = -of_rest.ldlt().solve(Eigen::MatrixXd(fit.information(rest, encoder)));
  const double variance = priors[kEncoderSine] * priors[kEncoderSine];
  RigMatrix covariance = fit.covariance;
  covariance(rest, rest) += variance * follows * follows.transpose();
  covariance(rest, encoder) = variance * follows;
  covariance(encoder, rest) = variance * follows.transpose();
  covariance.block<2, 2>(kEncoderSine, kEncoderSine) = variance * Eigen::Matrix2d::Identity();
  return covariance;
}

// The fit from any start.
RigFit solved_from(RigRecordings recordings, const RigUnknowns& first, const RigPriors& priors,
                   const Job& job) {
  RigFit fit = solve_rig_planes(recordings, first, priors, {}, job);
  if (!fit.converged && priors[kShiftU] > 0)
    fit = solved_from_around(recordings, std::move(fit), priors, job);
  return fit;
}

// The solution with the rig file's encoder, where surfaces do not determine another.
RigFit with_undetermined_encoder(RigRecordings recordings, const RigUnknowns& first, const RigPriors& priors,
                                 const Job& job) {
  const RigPriors held = without_encoder(priors);
  RigFit fit = with_scatter(recordings, solved_from(recordings, first, held, job), held, job);
  fit.covariance = covariance_with_encoder(fit, priors);
  return fit;
}

}  // namespace

RigLeastSquaresOptions near_the_solution() {
  RigLeastSquaresOptions options;
  options.first_loss_width_m = 0.03;
  return options;
}

bool nearly_converged(const RigFit& fit) {
  return fit.converged ||
         (fit.last_step.cwiseAbs().array() <= fit.covariance.diagonal().cwiseMax(0).cwiseSqrt().array())
             .all();
}

bool determined(const RigFit& fit, const RigPriors& priors, std::initializer_list<RigUnknown> unknowns) {
  constexpr double kBetter = 0.5;  // then three quarters of the information come from the recording
  if (fit.on_planes == 0 || !nearly_converged(fit)) return false;
  return std::all_of(unknowns.begin(), unknowns.end(),
                     [&](RigUnknown i) { return std::sqrt(fit.covariance(i, i)) < kBetter * priors[i]; });
}

RigFit with_scatter(RigRecordings recordings, RigFit fit, const RigPriors& priors, const Job& job) {
  fit.covariance += changes_by_smaller_cells(recordings, fit, priors, job) +
                    scatter_over_time(recordings, fit, priors, near_the_solution(), job);
  return fit;
}

RigSolution solution_of(RigRecordings recordings, const RigUnknowns& first, const RigPriors& priors,
                        const Job& job) {
  const RigPriors usual = with_usual_encoder(priors);
  RigFit fit = solved_from(recordings, first, usual, job);
  if (!fit.encoder_within_prior)
    return {with_undetermined_encoder(recordings, first, usual, job), priors, true};
  if (usual != priors && !shows_encoder(fit, usual)) {
    RigUnknowns given = fit.rig;
    given.encoder_rad.setZero();
    RigFit held = solve_rig_planes(recordings, given, priors, near_the_solution(), job);
    held.covariance += square(fit.rig.vector() - held.rig.vector());
    return {with_scatter(recordings, std::move(held), priors, job), priors};
  }
  fit.covariance += changes_by_smaller_cells(recordings, fit, usual, job);
  const auto undetermined = [&] {
    return priors[kEncoderSine] > 0 && !determined(fit, priors, {kEncoderSine, kEncoderCosine});
  };
  if (!undetermined()) fit.covariance += scatter_over_time(recordings, fit, usual, near_the_solution(), job);
  if (undetermined()) return {with_undetermined_encoder(recordings, first, priors, job), priors};
  return {std::move(fit), usual};
}

}  // namespace sweepscope
