#include "core/offset/walk/jerk_prior.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/loam/path/path_equations.hpp"
#include "core/numbers.hpp"

namespace sweepscope {
namespace {

// Of the rotation, and as many of the translation: over the 500 jerks of a part the trace errs by
// sqrt(2 / (6 * 500)), 3 %.
constexpr Eigen::Index kProbes = 6;

// How much faster the motor turns in the middle half of its sweeps than over all: 1 where it turns evenly,
// and the square root of 2 where its angle is a sine.
double haste_in_the_middle(const OffsetProblem& problem) {
  std::vector<double> hastes;
  const MotorTrack& track = problem.recording->motor;
  for (const Sweep& sweep : problem.motor.sweeps) {
    const auto angle_rad = [&](double u) {
      return track.angle_at(sweep.begin_s + u * (sweep.end_s - sweep.begin_s));
    };
    const double whole_rad = angle_rad(1) - angle_rad(0);
    if (std::abs(whole_rad) > problem.motor.range_rad / 2)
      hastes.push_back(2 * (angle_rad(0.75) - angle_rad(0.25)) / whole_rad);
  }
  if (hastes.empty()) return 1;
  return median(std::move(hastes));
}

}  // namespace

bool turns_back_smoothly(const OffsetProblem& problem) {
  constexpr double kSmooth = 1.25;  // about half way from an even motor's 1 to a sine's 1.41
  return haste_in_the_middle(problem) > kSmooth;
}

Eigen::Vector2d jerk_sigma(const OffsetProblem& problem, const std::vector<SweepPose>& sweeps,
                           const JointWalkOptions& options) {
  const Eigen::Vector2d seen = turns_back_smoothly(problem)
                                   ? options.jerk_factor_of_smooth_motors * jerk(sweeps, 1)
                                   : options.jerk_factor * jerk(sweeps, 2);
  return seen.cwiseMax(options.min_jerk);
}

// By the median of what is seen over half sweeps: a few of them may have been tracked badly.
Eigen::Vector2d acceleration_sigma(const std::vector<SweepPose>& sweeps, const MappingOptions& options) {
  constexpr std::size_t kParts = 2;
  constexpr double kMedianSquare = 2.366;  // of three normal components
  std::vector<double> rotation2, translation2;
  std::optional<Vector6d> last_per_s;
  for (const SweepPose& sweep : sweeps)
    for (const Vector6d& twist_per_s : twists_per_s(sweep, kParts)) {
      if (last_per_s) {
        const Vector6d change = (twist_per_s - *last_per_s) * double(kParts) / (sweep.end_s - sweep.begin_s);
        rotation2.push_back(change.head<3>().squaredNorm());
        translation2.push_back(change.tail<3>().squaredNorm());
      }
      last_per_s = twist_per_s;
    }
  const Eigen::Vector2d seen(std::sqrt(median(std::move(rotation2)) / kMedianSquare),
                             std::sqrt(median(std::move(translation2)) / kMedianSquare));
  return (options.acceleration_factor * seen)
      .cwiseMax(options.min_acceleration)
      .cwiseMin(options.max_acceleration);
}

std::vector<Vector6d> third_differences(const GuidedPath& path) {
  std::vector<Vector6d> differences;
  for (std::size_t k = 0; k + kJerkStencil.size() <= path.knots(); ++k) {
    const auto step = [&](std::size_t i) { return difference(path.knot(k + i + 1), path.knot(k + i)); };
    differences.emplace_back(step(2) - 2 * step(1) + step(0));
  }
  return differences;
}

std::vector<Vector6d> second_differences(const GuidedPath& path) {
  std::vector<Vector6d> differences;
  for (std::size_t k = 0; k + kAccelerationStencil.size() <= path.knots(); ++k)
    differences.emplace_back(difference(path.knot(k + 2), path.knot(k + 1)) -
                             difference(path.knot(k + 1), path.knot(k)));
  return differences;
}

// A column is the transposed stencils times random signs.
JerkEvidence::JerkEvidence(std::size_t knots, Eigen::Index unknowns)
    : probes_(Eigen::MatrixXd::Zero(unknowns, 2 * kProbes)) {
  std::mt19937 random(1);
  for (Eigen::Index probe = 0; probe < 2 * kProbes; ++probe) {
    const Eigen::Index part = probe < kProbes ? 0 : 3;
    for (std::size_t k = 0; k + kJerkStencil.size() <= knots; ++k)
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double sign = (random() & 0x10000u) != 0 ? 1 : -1;
        for (std::size_t a = 0; a < kJerkStencil.size(); ++a)
          probes_(Eigen::Index(6 * (k + a)) + part + axis, probe) += sign * kJerkStencil[a];
      }
  }
}

Eigen::Vector2d JerkEvidence::sigma(const GuidedPath& path, double knot_s, const Eigen::Vector2d& sigma,
                                    const Eigen::MatrixXd& solved_probes) const {
  const std::vector<Vector6d> differences = third_differences(path);
  const double count = 3 * double(differences.size()), per_jerk = std::pow(knot_s, 3);
  Eigen::Vector2d learned = sigma;
  for (Eigen::Index part = 0; part < 2; ++part) {
    double squares = 0, variance = 0;
    for (const Vector6d& d : differences) squares += d.segment<3>(3 * part).squaredNorm();
    for (Eigen::Index probe = part * kProbes; probe < (part + 1) * kProbes; ++probe)
      variance += probes_.col(probe).dot(solved_probes.col(probe)) / double(kProbes);
    const double used2 = std::pow(per_jerk * sigma[part], 2);
    const double determined = std::clamp(count - variance / used2, 1.0, count);
    learned[part] = std::sqrt(squares / determined) / per_jerk;
  }
  return learned;
}

}  // namespace sweepscope
