#include "core/rig_solve/rig_solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/recording/sweeps.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

constexpr double kOffsetPrior_s = 0.1;  // none, in effect

// The minimum standard deviation of the motor speed, relative to its mean, at which play differs from an
// offset: at one speed both turn the two directions against each other. Encoder steps and jitter make 1 %.
constexpr double kMinSpeedSpread = 0.05;

// Relative standard deviation of the speed over the steady parts of the sweeps, in pieces long enough that
// the steps of the encoder average out.
double speed_spread(const OffsetProblem& problem) {
  constexpr int kPieces = 8;  // 22 deg each of the usual sweep: 250 steps of the encoder
  const MotorTrack& track = problem.recording->motor;
  double sum = 0, squares = 0, count = 0;
  for (const Sweep& sweep : problem.motor.sweeps) {
    const double piece_s = (sweep.steady_end_s - sweep.steady_begin_s) / kPieces;
    if (!(piece_s > 0)) continue;
    for (int i = 0; i < kPieces; ++i) {
      const double from_s = sweep.steady_begin_s + i * piece_s;
      const double speed_rad_s =
          std::abs(track.angle_at(from_s + piece_s) - track.angle_at(from_s)) / piece_s;
      sum += speed_rad_s;
      squares += speed_rad_s * speed_rad_s;
      count += 1;
    }
  }
  if (count == 0 || sum == 0) return 0;
  const double mean = sum / count;
  return std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean;
}

// The set of cells changes between iterations, so that the last steps may oscillate; below sigma that is
// accepted.
bool nearly_converged(const RigFit& fit) {
  return fit.converged ||
         (fit.last_step.cwiseAbs().array() <= fit.covariance.diagonal().cwiseMax(0).cwiseSqrt().array())
             .all();
}

// A part is determined if its sigma is well below its prior.
bool determined(const RigFit& fit, const RigPriors& priors, std::initializer_list<RigUnknown> unknowns) {
  constexpr double kBetter = 0.5;  // then three quarters of the information come from the recording
  if (fit.on_planes == 0 || !nearly_converged(fit)) return false;
  return std::all_of(unknowns.begin(), unknowns.end(),
                     [&](RigUnknown i) { return std::sqrt(fit.covariance(i, i)) < kBetter * priors[i]; });
}

RigFinding finding(bool solved, bool identifiable, const char* reason) {
  return {solved, solved && identifiable, solved && !identifiable ? reason : ""};
}

// The sigma of the offset that comes from the other unknowns.
double added_sigma_s(const RigMatrix& covariance, const RigPriors& priors) {
  std::vector<int> others;
  for (int i = kOffset + 1; i < kRigUnknowns; ++i)
    if (priors[i] > 0) others.push_back(i);
  if (others.empty()) return 0;
  const Eigen::MatrixXd of_others = covariance(others, others);
  const Eigen::VectorXd with_offset = covariance(others, std::vector<int>{kOffset});
  return std::sqrt(std::max(0.0, with_offset.dot(of_others.ldlt().solve(with_offset))));
}

void set_gear(Rig::Gear& gear, const Gear& found) {
  const double phase_rad = gear.encoder_phase_deg * kRadPerDeg;
  const Eigen::Vector2d total_deg =
      gear.encoder_amplitude_deg * Eigen::Vector2d(std::cos(phase_rad), std::sin(phase_rad)) +
      found.encoder_rad * kDegPerRad;
  gear.play_deg += found.play_rad * kDegPerRad;
  gear.encoder_amplitude_deg = total_deg.norm();
  gear.encoder_phase_deg = total_deg.norm() > 0 ? std::atan2(total_deg[1], total_deg[0]) * kDegPerRad : 0.0;
}

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
RigFit solved_from_around(const OffsetProblem& problem, RigFit fit, const RigPriors& priors, const Job& job) {
  constexpr double kApart_m = 0.15;  // within the 0.2 m that a start may be wrong by
  const RigUnknowns begun = fit.rig;
  const auto goodness = [](const RigFit& a) {
    return std::pair(a.converged, double(a.on_planes) / double(std::max<std::size_t>(1, a.planes)));
  };
  for (const auto& shift_m : {Eigen::Vector2d(kApart_m, 0.0), Eigen::Vector2d(-kApart_m, 0.0),
                              Eigen::Vector2d(0.0, kApart_m), Eigen::Vector2d(0.0, -kApart_m)}) {
    RigUnknowns first = begun;
    first.shift_m = shift_m;
    const RigFit other = solve_rig_planes(problem, first, priors, {}, job);
    if (goodness(other) > goodness(fit)) fit = other;
  }
  return fit;
}

// The scatter of the solutions of groups of sweeps. Errors of whole scans, such as those of their stamps, are
// the same on all surfaces, and do not show when parts of the scene are left out.
RigMatrix scatter_over_time(const OffsetProblem& problem, const RigFit& fit, const RigPriors& priors,
                            const RigLeastSquaresOptions& options, const Job& job) {
  constexpr std::size_t kGroups = 4;  // of pairs of sweeps, one of each direction: 2 pairs each in 8 s
  const auto sweep_of = assign_sweeps(problem.recording->scans, problem.motor.sweeps, fit.rig.offset_s);
  std::vector<RigVector> found;
  for (std::size_t group = 0; group < kGroups && problem.motor.sweeps.size() >= 2 * kGroups; ++group) {
    OffsetProblem part = problem;
    for (std::size_t i = 0; i < sweep_of.size(); ++i)
      if (sweep_of[i] == kNoSweep || sweep_of[i] / 2 % kGroups != group) part.scan_used[i] = 0;
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

RigLeastSquaresOptions near_the_solution() {
  RigLeastSquaresOptions options;
  options.first_loss_width_m = 0.03;
  return options;
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
RigMatrix changes_by_smaller_cells(const OffsetProblem& problem, const RigFit& fit, const RigPriors& priors,
                                   const Job& job) {
  RigLeastSquaresOptions smaller = near_the_solution();
  RigUnknowns first = fit.rig;
  first.encoder_rad.setZero();
  RigMatrix sum = RigMatrix::Zero();
  for (const int levels : {2, 1}) {  // cells of at most 1 m and 0.5 m instead of 4 m
    smaller.max_levels = levels;
    RigFit other = solve_rig_planes(problem, first, priors, smaller, job);
    if (!other.encoder_within_prior)
      other = solve_rig_planes(problem, fit.rig, without_encoder(priors), smaller, job);
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

struct RigSolution {
  RigFit fit;
  RigPriors priors;                   // that it was found with
  bool encoder_beyond_prior = false;  // and therefore held
};

// The fit with all scatter in its covariance.
RigFit with_scatter(const OffsetProblem& problem, RigFit fit, const RigPriors& priors, const Job& job) {
  fit.covariance += changes_by_smaller_cells(problem, fit, priors, job) +
                    scatter_over_time(problem, fit, priors, near_the_solution(), job);
  return fit;
}

// The fit from any start.
RigFit solved_from(const OffsetProblem& problem, const RigUnknowns& first, const RigPriors& priors,
                   const Job& job) {
  RigFit fit = solve_rig_planes(problem, first, priors, {}, job);
  if (!fit.converged && priors[kShiftU] > 0) fit = solved_from_around(problem, std::move(fit), priors, job);
  return fit;
}

// The solution with the rig file's encoder, where surfaces do not determine another.
RigFit with_undetermined_encoder(const OffsetProblem& problem, const RigUnknowns& first,
                                 const RigPriors& priors, const Job& job) {
  const RigPriors held = without_encoder(priors);
  RigFit fit = with_scatter(problem, solved_from(problem, first, held, job), held, job);
  fit.covariance = covariance_with_encoder(fit, priors);
  return fit;
}

// A mount without its encoder is solved for with the rig file's encoder, unless the surfaces clearly show
// another. The difference between the two enters the covariance.
RigSolution solution_of(const OffsetProblem& problem, const RigUnknowns& first, const RigPriors& priors,
                        const Job& job) {
  const RigPriors usual = with_usual_encoder(priors);
  RigFit fit = solved_from(problem, first, usual, job);
  if (!fit.encoder_within_prior) return {with_undetermined_encoder(problem, first, usual, job), priors, true};
  if (usual != priors && !shows_encoder(fit, usual)) {
    RigUnknowns given = fit.rig;
    given.encoder_rad.setZero();
    RigFit held = solve_rig_planes(problem, given, priors, near_the_solution(), job);
    held.covariance += square(fit.rig.vector() - held.rig.vector());
    return {with_scatter(problem, std::move(held), priors, job), priors};
  }
  fit.covariance += changes_by_smaller_cells(problem, fit, usual, job);
  const auto undetermined = [&] {
    return priors[kEncoderSine] > 0 && !determined(fit, priors, {kEncoderSine, kEncoderCosine});
  };
  if (!undetermined()) fit.covariance += scatter_over_time(problem, fit, usual, near_the_solution(), job);
  if (undetermined()) return {with_undetermined_encoder(problem, first, priors, job), priors};
  return {std::move(fit), usual};
}

// The result of the fit, and which parts are determined.
SolvedRig solved_with(const OffsetProblem& problem, const RigSolution& solution, const RigSolve& what) {
  const RigFit& fit = solution.fit;
  const RigPriors& priors = solution.priors;
  SolvedRig solved;
  solved.mount = finding(what.mount, determined(fit, priors, {kTurnU, kTurnV, kShiftU, kShiftV}),
                         "The surfaces in view do not determine the mount: record where several walls, the "
                         "floor and the ceiling are in view.");
  solved.play = finding(what.play, priors[kPlay] > 0 && determined(fit, priors, {kPlay}),
                        "The recording does not determine the gear play.");
  solved.encoder = finding(what.encoder, determined(fit, priors, {kEncoderSine, kEncoderCosine}),
                           solution.encoder_beyond_prior
                               ? "The encoder's first harmonic would be more than four times its prior: the "
                                 "surfaces in view do not determine it, or the prior is too narrow."
                               : "The surfaces in view do not determine the encoder's first harmonic.");
  solved.found = fit.rig;
  if (!solved.mount.identifiable) {
    solved.found.turn_rad.setZero();
    solved.found.shift_m.setZero();
  }
  if (!solved.play.identifiable) solved.found.play_rad = 0;
  if (!what.encoder && priors[kEncoderSine] > 0)
    solved.encoder.reason = fmt::format(
        "Surfaces are flatter with an eccentric encoder, by {:.2f} deg: solve for the encoder as well "
        "(--solve offset,mount,encoder).",
        fit.rig.encoder_rad.norm() * kDegPerRad);
  if (!solved.encoder.identifiable) solved.found.encoder_rad.setZero();
  solved.priors = priors_of(what);
  solved.covariance = fit.covariance;
  solved.residual_after_m = fit.residual_m;
  solved.unevenness_m = fit.unevenness_m;
  solved.points = fit.points;
  solved.surfaces = fit.planes;
  solved.converged = fit.converged;
  solved.iterations = fit.iterations;
  solved.given = solved.rig = problem.recording->rig;
  solved.rig.mount = changed(solved.rig.mount, solved.found);
  set_gear(solved.rig.gear, solved.found.gear());
  return solved;
}

// Play that is not solved for acts as an offset; it may be as large as its prior.
void leave_play_open(SolvedRig& solved, double play_deg, double speed_rad_s, const char* reason) {
  const double play_rad = play_deg * kRadPerDeg;
  solved.play.reason = reason;
  solved.covariance(kPlay, kPlay) = play_rad * play_rad;
  solved.offset_sigma_s = std::hypot(solved.offset_sigma_s, play_rad / (2 * speed_rad_s));
}

}  // namespace

RigPriors priors_of(const RigSolve& what) {
  RigPriors priors = RigPriors::Zero();
  if (what.offset) priors[kOffset] = kOffsetPrior_s;
  if (what.mount) {
    priors[kTurnU] = priors[kTurnV] = what.mount_deg * kRadPerDeg;
    priors[kShiftU] = priors[kShiftV] = what.mount_mm * 1e-3;
  }
  if (what.play) priors[kPlay] = what.play_deg * kRadPerDeg;
  if (what.encoder) priors[kEncoderSine] = priors[kEncoderCosine] = what.encoder_deg * kRadPerDeg;
  return priors;
}

SolvedRig solve_rig(const OffsetProblem& problem, double first_offset_s, const RigSolve& what,
                    const Job& job) {
  RigUnknowns first;
  first.offset_s = first_offset_s;
  RigSolve nothing;
  nothing.offset = what.offset;
  const RigFit before = solve_rig_planes(problem, first, priors_of(nothing), {}, job);
  const bool one_speed = what.play && speed_spread(problem) < kMinSpeedSpread;
  RigSolve separable = what;
  separable.play = what.play && !one_speed;
  const RigSolution solution = solution_of(problem, first, priors_of(separable), job);
  const RigFit& fit = solution.fit;
  SolvedRig solved = solved_with(problem, solution, what);
  ResidualGridOptions grid;
  grid.loss_width_m = RigLeastSquaresOptions().loss_width_m(fit.residual_m);
  solved.residuals = rig_residuals(problem, before.rig, solved.found, grid);
  // The surfaces that a wrong rig shows are often the flat halves of others.
  solved.residual_before_m = std::max(before.residual_m, solved.residuals.before_m);
  solved.offset_sigma_s = added_sigma_s(fit.covariance, solution.priors);
  if (one_speed)
    leave_play_open(solved, what.play_deg, problem.motor.median_speed_rad_s,
                    "The motor turns at one speed only, at which gear play has the same effect as an offset. "
                    "Record two sweep speeds in one recording to separate them.");
  return solved;
}

SolvedRig rig_of_walk(const OffsetProblem& problem, const WalkTurn& turn, const RigSolve& what) {
  SolvedRig solved;
  solved.along_walk = true;
  solved.given = solved.rig = problem.recording->rig;
  solved.priors = priors_of(what);
  solved.covariance.diagonal() = solved.priors.cwiseProduct(solved.priors);
  if (what.mount) {
    const Eigen::Matrix2d prior = solved.covariance.block<2, 2>(kTurnU, kTurnU);
    const Eigen::Matrix2d gain = prior * (prior + turn.covariance).inverse();
    solved.found.turn_rad = gain * turn.turn_rad;
    solved.covariance.block<2, 2>(kTurnU, kTurnU) = gain * turn.covariance;
    solved.rig.mount = changed(solved.rig.mount, solved.found);
  }
  solved.mount = {
      what.mount, what.mount,
      what.mount
          ? "A walk determines how the laser is turned, but not its position: its shift is the rig file's."
          : ""};
  solved.encoder =
      finding(what.encoder, false,
              "A walk does not determine the encoder's first harmonic: record 8 s of the stationary rig.");
  if (what.play) {
    solved.play.solved = true;
    leave_play_open(
        solved, what.play_deg, problem.motor.median_speed_rad_s,
        "A walk does not determine the gear play: record 8 s of the stationary rig at two motor speeds.");
  }
  return solved;
}

Recording with_rig(Recording recording, const SolvedRig& solved) {
  recording.rig = solved.rig;
  recording.motor = laser_angles(recording.motor, solved.found.gear());
  return recording;
}

}  // namespace sweepscope
