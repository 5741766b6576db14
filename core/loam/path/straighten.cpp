#include "core/loam/path/straighten.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/loam/path/path_equations.hpp"

namespace sweepscope {
namespace {

// Of a sweep the path is looked at in so many instants, the first and the last half a step from its ends: a
// sweep may begin some mm beside the end of the one before.
constexpr int kInstants = 10;

// The motor's angle within a sweep, from -1 to 1 along a whole forward one, for a speed that does not change.
struct MotorAngle {
  double begin, end;
  double at(double u) const { return begin + u * (end - begin); }
};

// The first sweep and the last one may be recorded in part: they last as long as their neighbour from the
// reversal that they share with it.
MotorAngle motor_angle(std::span<const SweepPose> stretch, std::size_t k) {
  const auto duration_s = [](const SweepPose& sweep) { return sweep.end_s - sweep.begin_s; };
  const auto part_of = [&](const SweepPose& whole) {
    return std::min(1.0, duration_s(stretch[k]) / duration_s(whole));
  };
  const double d = stretch[k].direction;
  if (k == 0 && stretch.size() > 1) return {d * (1 - 2 * part_of(stretch[1])), d};
  if (k > 0 && k + 1 == stretch.size()) return {-d, d * (2 * part_of(stretch[k - 1]) - 1)};
  return {-d, d};
}

// Sums over the accelerations of a path, weighted by their durations: of the motor and of the rig.
struct Sums {
  double motor2 = 0;
  Vector6d product = Vector6d::Zero(), rig2 = Vector6d::Zero();
  std::size_t count = 0, reversals = 0;
};

struct Instant {
  double time_s, angle;
  Pose pose;
};

void add_acceleration(const Instant& before, const Instant& at, const Instant& after, Sums& sums) {
  const double first_s = at.time_s - before.time_s, second_s = after.time_s - at.time_s;
  const double between_s = (first_s + second_s) / 2;
  const double motor = (after.angle - at.angle) / second_s - (at.angle - before.angle) / first_s;
  const Vector6d rig =
      difference(after.pose, at.pose) / second_s - difference(at.pose, before.pose) / first_s;
  sums.motor2 += motor * motor / between_s;
  sums.product += motor * rig / between_s;
  sums.rig2 += rig.cwiseProduct(rig) / between_s;
  ++sums.count;
}

// Of sweeps [first, end), which follow each other without a gap.
void add_run(std::span<const SweepPose> stretch, std::size_t first, std::size_t end, Sums& sums) {
  sums.reversals += end - first - 1;
  std::vector<Instant> instants;
  for (std::size_t k = first; k < end; ++k) {
    const SweepPose& sweep = stretch[k];
    const MotorAngle angle = motor_angle(stretch, k);
    for (int i = 0; i < kInstants; ++i) {
      const double u = (i + 0.5) / kInstants;
      instants.push_back({sweep.begin_s + u * (sweep.end_s - sweep.begin_s), angle.at(u), sweep.at(u)});
    }
  }
  for (std::size_t i = 1; i + 1 < instants.size(); ++i)
    add_acceleration(instants[i - 1], instants[i], instants[i + 1], sums);
}

bool follows(const SweepPose& sweep, const SweepPose& last) {
  const double gap_s = sweep.begin_s - last.end_s;
  return !sweep.lost && !last.lost && sweep.direction == -last.direction &&
         gap_s < (last.end_s - last.begin_s) / kInstants;
}

// By how much the path deviates at the motor's angle 1: least squares, and what of it exceeds its
// uncertainty.
Vector6d deviation_of(std::span<const SweepPose> stretch) {
  Sums sums;
  for (std::size_t first = 0, end = 1; first < stretch.size(); first = end++) {
    while (end < stretch.size() && follows(stretch[end], stretch[end - 1])) ++end;
    add_run(stretch, first, end, sums);
  }
  Vector6d deviation = Vector6d::Zero();
  constexpr std::size_t kMinReversals = 4;  // fewer may be what the rig did
  if (sums.reversals < kMinReversals) return deviation;
  constexpr double kSigmas = 2;
  for (int i = 0; i < 6; ++i) {
    const double found = sums.product[i] / sums.motor2;
    const double rest2 = std::max(0.0, sums.rig2[i] - found * sums.product[i]);
    const double sigma2 = rest2 / (double(sums.count) * sums.motor2);
    if (found * found > kSigmas * kSigmas * sigma2)
      deviation[i] = found * (1 - kSigmas * kSigmas * sigma2 / (found * found));
  }
  return deviation;
}

void straighten(std::span<SweepPose> stretch) {
  const Vector6d deviation = deviation_of(stretch);
  if (deviation.isZero(0)) return;
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    const MotorAngle angle = motor_angle(stretch, k);
    std::vector<Pose>& knots = stretch[k].knots;
    for (std::size_t i = 0; i < knots.size(); ++i)
      knots[i] = stepped(knots[i], -angle.at(double(i) / double(knots.size() - 1)) * deviation,
                         knots[i].translation_m);
  }
}

}  // namespace

std::vector<SweepPose> straightened(std::vector<SweepPose> sweeps) {
  for (std::size_t first = 0, end = 0; first < sweeps.size(); first = end) {
    while (end < sweeps.size() && sweeps[end].stretch == sweeps[first].stretch) ++end;
    if (sweeps[first].stretch > 0) straighten(std::span(sweeps).subspan(first, end - first));
  }
  return sweeps;
}

}  // namespace sweepscope
