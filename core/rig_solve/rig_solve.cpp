#include "core/rig_solve/rig_solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/rig_solve/rig_solution.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {
namespace {

constexpr double kOffsetPrior_s = 0.1;  // none, in effect

// The minimum standard deviation of the motor speed, relative to its mean, at which play differs from an
// offset: at one speed both turn the two directions against each other. Encoder steps and jitter make 1 %.
constexpr double kMinSpeedSpread = 0.05;

// The motor's speed in pieces of the steady parts of the sweeps, long enough that the steps of the encoder
// average out.
std::vector<double> speeds_rad_s(const OffsetProblem& problem) {
  constexpr int kPieces = 8;  // 22 deg each of the usual sweep: 250 steps of the encoder
  const MotorTrack& track = problem.recording->motor;
  std::vector<double> speeds;
  for (const Sweep& sweep : problem.motor.sweeps) {
    const double piece_s = (sweep.steady_end_s - sweep.steady_begin_s) / kPieces;
    for (int i = 0; i < kPieces && piece_s > 0; ++i) {
      const double from_s = sweep.steady_begin_s + i * piece_s;
      speeds.push_back(std::abs(track.angle_at(from_s + piece_s) - track.angle_at(from_s)) / piece_s);
    }
  }
  return speeds;
}

// Its relative standard deviation.
double speed_spread(RigRecordings recordings) {
  double sum = 0, squares = 0, count = 0;
  for (const OffsetProblem& problem : recordings)
    for (const double speed_rad_s : speeds_rad_s(problem)) {
      sum += speed_rad_s;
      squares += speed_rad_s * speed_rad_s;
      count += 1;
    }
  if (count == 0 || sum == 0) return 0;
  const double mean = sum / count;
  return std::sqrt(std::max(0.0, squares / count - mean * mean)) / mean;
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

// The result of the fit, and which parts are determined.
SolvedRig solved_with(const Rig& given, const RigSolution& solution, const RigSolve& what) {
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
  solved.given = solved.rig = given;
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

SolvedRig solve_rig(RigRecordings recordings, const RigUnknowns& first, const RigSolve& what,
                    const Job& job) {
  RigSolve nothing;
  nothing.offset = what.offset;
  const RigFit before = solve_rig_planes(recordings, first, priors_of(nothing), {}, job);
  const bool one_speed = what.play && speed_spread(recordings) < kMinSpeedSpread;
  RigSolve separable = what;
  separable.play = what.play && !one_speed;
  const RigSolution solution = solution_of(recordings, first, priors_of(separable), job);
  const RigFit& fit = solution.fit;
  SolvedRig solved = solved_with(recordings.front().recording->rig, solution, what);
  ResidualGridOptions grid;
  grid.loss_width_m = RigLeastSquaresOptions().loss_width_m(fit.residual_m);
  solved.before = before.rig;
  solved.residuals =
      rig_residuals(recordings.front(), before.rig.of_recording(0), solved.found.of_recording(0), grid);
  // The surfaces that a wrong rig shows are often the flat halves of others.
  solved.residual_before_m = std::max(before.residual_m, solved.residuals.before_m);
  solved.offset_sigma_s = added_sigma_s(fit.covariance, solution.priors);
  for (const RigVector& follows : fit.offsets_follow)
    solved.own_offset_sigma_s.push_back(std::sqrt(std::max(0.0, follows.dot(fit.covariance * follows))));
  if (one_speed)
    leave_play_open(solved, what.play_deg, recordings.front().motor.median_speed_rad_s,
                    "The motor turns at one speed only, at which gear play has the same effect as an offset. "
                    "Record two sweep speeds to separate them.");
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
  recording.rig.mount = solved.rig.mount;
  recording.rig.gear = solved.rig.gear;
  recording.motor = laser_angles(recording.motor, solved.found.gear());
  return recording;
}

}  // namespace sweepscope
