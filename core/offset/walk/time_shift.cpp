#include "core/offset/walk/time_shift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "core/loam/path/smooth_path.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A step is a scan at 40 Hz; windows of four overlap, so that a turn between two steps is not missed.
constexpr double kStep_s = 0.025, kWindow_s = 0.1;
constexpr double kShortest_s = 3;  // of what is compared: six turns that err independently
constexpr double kKnot_s = 0.06;   // of the tracked path, as in JointWalkOptions

// How the base turned from an instant to kWindow_s later, in the base frame.
struct Turn {
  std::int64_t step;  // the instant, in steps of kStep_s
  Vector3d turn_rad;
};

double time_of(std::int64_t step) {
  return double(step) * kStep_s;
}

template <typename Path>
Vector3d turn_rad(const Path& path, double time_s) {
  return turn_between(path.at(time_s).rotation, path.at(time_s + kWindow_s).rotation);
}

void add_turns(const std::vector<SweepPose>& run, std::vector<Turn>& turns) {
  const SmoothPath path(run, kKnot_s);
  const double last_s = run.back().end_s - kWindow_s;
  for (auto step = std::int64_t(std::ceil(run.front().begin_s / kStep_s)); time_of(step) <= last_s; ++step)
    turns.push_back({step, turn_rad(path, time_of(step))});
}

std::vector<Turn> turns_of(const std::vector<SweepPose>& sweeps) {
  std::vector<Turn> turns;
  for (const std::vector<SweepPose>& run : tracked_runs(sweeps)) add_turns(run, turns);
  return turns;
}

// Every step that the given motion covers, with no shift; not finite where it has a gap.
struct GivenTurns {
  std::int64_t first = 0;
  std::vector<Vector3d> turns_rad;
};
GivenTurns turns_of(const GivenMotion& given) {
  GivenTurns found;
  found.first = std::int64_t(std::ceil(given.begin_s() / kStep_s));
  for (std::int64_t step = found.first; time_of(step) + kWindow_s <= given.end_s(); ++step) {
    const double time_s = time_of(step);
    found.turns_rad.push_back(given.covers(time_s, time_s + kWindow_s) ? turn_rad(given, time_s)
                                                                       : Vector3d::Constant(std::nan("")));
  }
  return found;
}

// Sums over the pairs of turns about one axis.
struct Axis {
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  // Pearson's; 0 where it is negative.
  double correlation(double count) const {
    const double of_x = xx - x * x / count, of_y = yy - y * y / count;
    return of_x > 0 && of_y > 0 ? std::max(0.0, (xy - x * y / count) / std::sqrt(of_x * of_y)) : 0;
  }
};

// The logarithm of how much likelier the turns are where the given ones happened `lag` steps earlier than
// where they have nothing to do with each other; 0 where they overlap too little. Each axis has an unknown
// noise: about the motor's axis tracked sweeps turn to and fro.
double likelihood(const std::vector<Turn>& turns, const GivenTurns& given, std::int64_t lag) {
  constexpr double kIndependent_s = 0.5;  // a sweep: turns that lie so far apart err independently
  std::array<Axis, 3> axes;
  double count = 0;
  for (const Turn& turn : turns) {
    const std::int64_t at = turn.step - lag - given.first;
    if (at < 0 || at >= std::int64_t(given.turns_rad.size())) continue;
    const Vector3d& other_rad = given.turns_rad[std::size_t(at)];
    if (!other_rad.allFinite()) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = turn.turn_rad[Eigen::Index(i)], y = other_rad[Eigen::Index(i)];
      Axis& axis = axes[i];
      axis.x += x, axis.y += y, axis.xx += x * x, axis.yy += y * y, axis.xy += x * y;
    }
    ++count;
  }
  if (count * kStep_s < kShortest_s) return 0;
  double sum = 0;
  for (const Axis& axis : axes) {
    const double correlation = axis.correlation(count);
    sum -= std::log(std::max(1e-6, 1 - correlation * correlation));
  }
  return count * kStep_s / kIndependent_s / 2 * sum;
}

// Clocks that are meant to be the same one are likelier than others, as 1 / (1 + |shift| / 0.5 s)^2.
double prior_of(double shift_s) {
  return -2 * std::log(1 + std::abs(shift_s) / 0.5);
}

// Gauss-Newton on the shift. Neighbouring windows err together: the sigma is that of sums over whole seconds.
TimeShift refined(const std::vector<Turn>& turns, const GivenMotion& given, double shift_s) {
  constexpr double kLoss_rad = 0.02;  // ten times what a tracked turn of kWindow_s errs by
  constexpr double kDelta_s = 0.005;  // of the central difference: a fifth of a step
  TimeShift found{shift_s, 0};
  for (int iteration = 0; iteration < 8; ++iteration) {
    const GivenMotion here = given.with_time_shift(found.time_s);
    std::map<std::int64_t, double> pulls;
    double information = 0, gradient = 0;
    for (const Turn& turn : turns) {
      const double time_s = time_of(turn.step);
      if (!here.covers(time_s - kDelta_s, time_s + kWindow_s + kDelta_s)) continue;
      const Vector3d residual_rad = turn.turn_rad - turn_rad(here, time_s);
      const Vector3d slope =
          (turn_rad(here, time_s + kDelta_s) - turn_rad(here, time_s - kDelta_s)) / (2 * kDelta_s);
      const double weight = 1 / (1 + residual_rad.squaredNorm() / (kLoss_rad * kLoss_rad));
      information += weight * slope.squaredNorm();
      gradient += weight * slope.dot(residual_rad);
      pulls[std::int64_t(std::floor(time_s))] += weight * slope.dot(residual_rad);
    }
    if (!(information > 0)) return found;
    const double step_s = std::clamp(-gradient / information, -kStep_s, kStep_s);
    found.time_s += step_s;
    double squares = 0;
    for (const auto& [second, pull] : pulls) squares += pull * pull;
    found.sigma_s = std::sqrt(squares) / information;
    if (std::abs(step_s) < 1e-6) break;
  }
  return found;
}

}  // namespace

std::optional<TurnCorrelation> correlate_turns(const std::vector<SweepPose>& sweeps,
                                               const GivenMotion& given) {
  const std::vector<Turn> turns = turns_of(sweeps);
  if (double(turns.size()) * kStep_s < kShortest_s) return std::nullopt;
  const GivenMotion unshifted = given.with_time_shift(0);
  const GivenTurns of_given = turns_of(unshifted);
  const std::int64_t least = turns.front().step - (of_given.first + std::int64_t(of_given.turns_rad.size()));
  const std::int64_t most = turns.back().step - of_given.first;
  std::vector<double> likelihoods;
  for (std::int64_t lag = least; lag <= most; ++lag)
    likelihoods.push_back(likelihood(turns, of_given, lag) + prior_of(time_of(lag)));
  const auto best = std::max_element(likelihoods.begin(), likelihoods.end());
  if (best == likelihoods.end()) return std::nullopt;
  const double shift_s = time_of(least + (best - likelihoods.begin()));
  TurnCorrelation found;
  found.likelihood = *best - prior_of(shift_s);
  constexpr std::ptrdiff_t kApart =
      16;  // steps: four windows, so that the flanks of the best peak are no rival
  double rival = 0;
  for (auto at = likelihoods.begin(); at != likelihoods.end(); ++at)
    if (std::abs(at - best) > kApart) rival = std::max(rival, *at);
  found.lead = *best - rival;
  // Of the thousands of shifts tried, one is likelier by e^15 by chance once in some thousand times; and the
  // best one is to be e^4, 55 times, as likely as its rival.
  constexpr double kClear = 15, kClearLead = 4;
  found.clear = found.likelihood > kClear && found.lead > kClearLead;
  found.shift = refined(turns, unshifted, shift_s);
  return found;
}

TimeShift mean_of(const std::vector<TimeShift>& shifts) {
  double weights = 0, sum_s = 0, scatter2 = 0;
  for (const TimeShift& shift : shifts) {
    const double weight = 1 / (shift.sigma_s * shift.sigma_s);
    weights += weight;
    sum_s += weight * shift.time_s;
  }
  const double mean_s = sum_s / weights, freedom = double(shifts.size()) - 1;
  for (const TimeShift& shift : shifts)
    scatter2 += (shift.time_s - mean_s) * (shift.time_s - mean_s) / (shift.sigma_s * shift.sigma_s);
  // A few parts are a poor sample of their scatter: the scatter on other walks counts as kPriorParts more.
  // Errors that all parts share (beams' times, surfaces that are not flat) remain.
  constexpr double kPriorParts = 4, kPriorScatter2 = 1.5, kUnseen_s = 0.1e-3;
  const double widened2 = (scatter2 + kPriorParts * kPriorScatter2) / (freedom + kPriorParts);
  return {mean_s, std::hypot(std::sqrt(std::max(1.0, widened2) / weights), kUnseen_s)};
}

}  // namespace sweepscope
