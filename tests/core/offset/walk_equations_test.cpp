#include "core/offset/walk_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/loam/given_motion.hpp"
#include "core/offset/jerk_prior.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using Role = GivenMotion::Role;

const Vector3d kAxis = Vector3d(1, 0.2, -0.1).normalized(), kPoint_m(1, 3, -2);
const Vector3d kNormal = Vector3d(0.5, -1, 0.7).normalized();
constexpr double kAngle_rad = 0.7, kSpeed_rad_s = 6.3;

// A body that walks, sways and turns.
Pose pose_at(double t_s) {
  const Vector3d turn_rad(0.1 * std::sin(2 * t_s), 0.2 * std::cos(3 * t_s), 0.5 * std::sin(t_s));
  return {rotation_from_vector(turn_rad), {t_s, std::sin(t_s), 0.1 * std::cos(4 * t_s)}};
}

std::vector<SweepPose> tracked_sweeps() {
  std::vector<SweepPose> sweeps(3);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    sweeps[k].begin_s = 2 + 0.5 * double(k);
    sweeps[k].end_s = sweeps[k].begin_s + 0.5;
    sweeps[k].knots.clear();
    for (int i = 0; i <= 20; ++i) sweeps[k].knots.push_back(pose_at(sweeps[k].begin_s + 0.025 * i));
  }
  return sweeps;
}

// Without a given motion, along one that is a prior, and along one that is the truth.
GuidedPath path_of(std::optional<Role> role) {
  if (!role) return {tracked_sweeps(), 0.06, nullptr};
  std::vector<StampedPose> poses;
  for (double t_s = 0; t_s < 6; t_s += 0.02)
    poses.push_back({t_s, pose_at(t_s).translation_m, pose_at(t_s).rotation});
  const GivenMotion given(poses, GivenMotion::Parts::kRotationAndTranslation, *role);
  return {tracked_sweeps(), 0.06, &given};
}

GuidedPath moved(GuidedPath path, Eigen::Index unknown, double step) {
  std::vector<Vector6d> steps(path.blocks(), Vector6d::Zero());
  steps[std::size_t(unknown / 6)][unknown % 6] = step;
  path.move(steps);
  return path;
}

// Where what a beam hit lies in the map, at an offset that is longer by `more_s`.
Vector3d in_map_m(const GuidedPath& path, double t_s, double more_s) {
  return path.at(t_s) * (rotation_from_vector((kAngle_rad + more_s * kSpeed_rad_s) * kAxis) * kPoint_m);
}

ScanMotion scan_at(const GuidedPath& path, double t_s) {
  const Pose pose = path.at(t_s);
  return {path.place(t_s), pose.translation_m, kSpeed_rad_s * (pose.rotation * kAxis)};
}

Eigen::VectorXd dense(const KnotRow& row, Eigen::Index unknowns) {
  Eigen::VectorXd all(unknowns);
  for (Eigen::Index i = 0; i < unknowns; ++i) all[i] = row.times(Eigen::VectorXd::Unit(unknowns, i));
  return all;
}

class WalkEquationsOf : public testing::TestWithParam<std::optional<Role>> {};
INSTANTIATE_TEST_SUITE_P(Motions, WalkEquationsOf,
                         testing::Values(std::nullopt, std::optional(Role::kPrior),
                                         std::optional(Role::kTruth)));

TEST_P(WalkEquationsOf, APointsRowIsThatOfFiniteDifferences) {
  constexpr double kStep = 1e-4, kShare = -0.3;
  const GuidedPath path = path_of(GetParam());
  const auto unknowns = Eigen::Index(6 * path.blocks());
  ASSERT_GT(unknowns, 0);
  for (const double t_s : {2.31, 2.75, 3.123}) {
    const Vector3d p_m = in_map_m(path, t_s, 0);
    KnotRow row;
    const double slope = row.add_point(path, scan_at(path, t_s), p_m, kNormal, kShare);
    Eigen::VectorXd numeric(unknowns);
    for (Eigen::Index i = 0; i < unknowns; ++i)
      numeric[i] =
          kShare *
          kNormal.dot(in_map_m(moved(path, i, kStep), t_s, 0) - in_map_m(moved(path, i, -kStep), t_s, 0)) /
          (2 * kStep);
    // The spline's rotations do not quite add up, and between its samples it goes linearly.
    EXPECT_LT((dense(row, unknowns) - numeric).norm(), 0.02 * numeric.norm()) << t_s;
    const double numeric_slope =
        kShare * kNormal.dot(in_map_m(path, t_s, kStep) - in_map_m(path, t_s, -kStep)) / (2 * kStep);
    EXPECT_NEAR(slope, numeric_slope, 1e-5 * std::abs(numeric_slope)) << t_s;
  }
}

TEST(WalkEquations, PointsThatShareAKnotAddUpInItsRow) {
  const GuidedPath path = path_of(std::nullopt);
  const auto unknowns = Eigen::Index(6 * path.blocks());
  KnotRow one, other, both;
  const auto add = [&](KnotRow& row, double t_s, double share) {
    row.add_point(path, scan_at(path, t_s), in_map_m(path, t_s, 0), kNormal, share);
  };
  add(one, 2.31, 1);
  add(other, 2.4, -0.5);
  add(both, 2.31, 1);
  add(both, 2.4, -0.5);
  EXPECT_LT(both.size(), one.size() + other.size());
  EXPECT_LT((dense(both, unknowns) - dense(one, unknowns) - dense(other, unknowns)).norm(), 1e-12);
}

// A path whose acceleration changes.
GuidedPath shaken() {
  GuidedPath path = path_of(std::nullopt);
  std::vector<Vector6d> steps(path.blocks());
  for (std::size_t k = 0; k < steps.size(); ++k)
    for (int i = 0; i < 6; ++i) steps[k][i] = 0.01 * std::sin(double(k * k) + 1.7 * i);
  path.move(steps);
  return path;
}

TEST(WalkEquations, JerksHaveTheGradientOfTheirSquares) {
  constexpr double kStep = 1e-5;
  const Eigen::Vector2d sigma(0.2, 0.5);
  const GuidedPath path = shaken();
  const auto cost = [&](const GuidedPath& at) {
    double sum = 0;
    for (const Vector6d& jerk : third_differences(at))
      sum += (jerk.head<3>() / sigma[0]).squaredNorm() / 2 + (jerk.tail<3>() / sigma[1]).squaredNorm() / 2;
    return sum;
  };
  WalkEquations equations(path.blocks());
  equations.add_jerks(path, sigma);
  Eigen::VectorXd numeric(Eigen::Index(6 * path.blocks()));
  for (Eigen::Index i = 0; i < numeric.size(); ++i)
    numeric[i] = (cost(moved(path, i, kStep)) - cost(moved(path, i, -kStep))) / (2 * kStep);
  EXPECT_LT((equations.gradient().head(numeric.size()) - numeric).norm(), 0.05 * numeric.norm());
}

TEST(WalkEquations, TheSolutionIsThatOfTheWholeMatrix) {
  const GuidedPath path = path_of(std::nullopt);
  const auto unknowns = Eigen::Index(6 * path.blocks()), last = unknowns;
  WalkEquations equations(path.blocks());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns + 1, unknowns + 1);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(unknowns + 1);
  for (int i = 0; i < 40; ++i) {
    const double t_s = 2.05 + 0.035 * i, residual = 0.01 * std::sin(3.0 * i), weight = 1 + 0.1 * i;
    KnotRow row;
    const double slope = row.add_point(path, scan_at(path, t_s), in_map_m(path, t_s, 0), kNormal, 1);
    equations.add(row, slope, residual, weight);
    Eigen::VectorXd whole(unknowns + 1);
    whole << dense(row, unknowns), slope;
    matrix += weight * whole * whole.transpose();
    gradient += weight * residual * whole;
  }
  constexpr double kFirst = 0.01, kKnot = 0.5, kOffset_s = 0.02;
  equations.hold(path.knots(), kFirst, kKnot, kOffset_s);
  matrix.diagonal().head(unknowns).array() += 1 / (kKnot * kKnot);
  matrix.diagonal().head<6>().array() += 1 / (kFirst * kFirst);
  matrix(last, last) += 1 / (kOffset_s * kOffset_s);
  EXPECT_LT((equations.gradient() - gradient).norm(), 1e-10 * gradient.norm());
  const Eigen::MatrixXd inverse = matrix.inverse();
  const Eigen::VectorXd step = -inverse * gradient;
  const auto solution = equations.solve(std::nullopt, Eigen::MatrixXd(unknowns + 1, 0));
  ASSERT_TRUE(solution);
  EXPECT_NEAR(solution->offset_step_s, step[last], 1e-9 * std::abs(step[last]));
  EXPECT_NEAR(solution->offset_sigma_s, std::sqrt(inverse(last, last)), 1e-9);
  EXPECT_LT((solution->influence - inverse.col(last)).norm(), 1e-8 * inverse.col(last).norm());
  ASSERT_EQ(solution->block_steps.size(), path.blocks());
  for (std::size_t k = 0; k < path.blocks(); ++k)
    EXPECT_LT((solution->block_steps[k] - step.segment<6>(Eigen::Index(6 * k))).norm(), 1e-9 * step.norm());
}

}  // namespace
}  // namespace sweepscope
