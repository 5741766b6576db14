#include "core/offset/walk/walk_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/loam/path/given_motion.hpp"
#include "core/offset/walk/jerk_prior.hpp"

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

// By all unknowns but the offset.
Eigen::VectorXd dense(const ScanRow& row, const std::vector<ScanMotion>& motions, const GuidedPath& path) {
  Eigen::VectorXd all(Eigen::Index(6 * path.blocks()));
  for (Eigen::Index k = 0; k < all.size(); ++k) {
    const Eigen::VectorXd step = Eigen::VectorXd::Unit(all.size(), k);
    all[k] = 0;
    for (std::size_t i = 0; i < row.size(); ++i)
      all[k] += row.row(i).dot(by_pose(step, motions[row.scan(i)], path));
  }
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
    ScanRow row;
    const std::vector<ScanMotion> motions{scan_at(path, t_s)};
    const double slope = row.add_point(0, motions[0], p_m, kNormal, kShare);
    Eigen::VectorXd numeric(unknowns);
    for (Eigen::Index i = 0; i < unknowns; ++i)
      numeric[i] =
          kShare *
          kNormal.dot(in_map_m(moved(path, i, kStep), t_s, 0) - in_map_m(moved(path, i, -kStep), t_s, 0)) /
          (2 * kStep);
    // The spline's rotations do not quite add up, and between its samples it goes linearly.
    EXPECT_LT((dense(row, motions, path) - numeric).norm(), 0.02 * numeric.norm()) << t_s;
    const double numeric_slope =
        kShare * kNormal.dot(in_map_m(path, t_s, kStep) - in_map_m(path, t_s, -kStep)) / (2 * kStep);
    EXPECT_NEAR(slope, numeric_slope, 1e-5 * std::abs(numeric_slope)) << t_s;
  }
}

TEST(WalkEquations, PointsOfOneScanAddUpInItsRow) {
  const GuidedPath path = path_of(std::nullopt);
  const std::vector<ScanMotion> motions{scan_at(path, 2.31), scan_at(path, 2.4)};
  const Vector3d a_m = in_map_m(path, 2.31, 0), b_m = a_m + Vector3d(0.3, -0.1, 0.2);
  ScanRow first, second, both;
  first.add_point(0, motions[0], a_m, kNormal, 1);
  second.add_point(0, motions[0], b_m, kNormal, -0.5);
  both.add_point(0, motions[0], a_m, kNormal, 1);
  both.add_point(1, motions[1], a_m, kNormal, -0.5);
  both.add_point(0, motions[0], b_m, kNormal, -0.5);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_LT((both.row(0) - first.row(0) - second.row(0)).norm(), 1e-12);
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
  const ScanEquations none(0);
  const std::vector<ScanMotion> motions;
  WalkEquations equations(none, motions, path);
  equations.add_jerks(sigma);
  Eigen::VectorXd numeric(Eigen::Index(6 * path.blocks()));
  for (Eigen::Index i = 0; i < numeric.size(); ++i)
    numeric[i] = (cost(moved(path, i, kStep)) - cost(moved(path, i, -kStep))) / (2 * kStep);
  EXPECT_LT((equations.gradient().head(numeric.size()) - numeric).norm(), 0.05 * numeric.norm());
}

TEST(WalkEquations, AccelerationsHaveTheGradientOfTheirSquares) {
  constexpr double kStep = 1e-5;
  const Eigen::Vector2d sigma(0.2, 0.5);
  const GuidedPath path = shaken();
  const auto cost = [&](const GuidedPath& at) {
    double sum = 0;
    for (std::size_t k = 0; k + 2 < at.knots(); ++k) {
      const Vector6d change =
          difference(at.knot(k + 2), at.knot(k + 1)) - difference(at.knot(k + 1), at.knot(k));
      sum +=
          (change.head<3>() / sigma[0]).squaredNorm() / 2 + (change.tail<3>() / sigma[1]).squaredNorm() / 2;
    }
    return sum;
  };
  const ScanEquations none(0);
  const std::vector<ScanMotion> motions;
  WalkEquations equations(none, motions, path);
  equations.add_accelerations(sigma);
  Eigen::VectorXd numeric(Eigen::Index(6 * path.blocks()));
  for (Eigen::Index i = 0; i < numeric.size(); ++i)
    numeric[i] = (cost(moved(path, i, kStep)) - cost(moved(path, i, -kStep))) / (2 * kStep);
  EXPECT_LT((equations.gradient().head(numeric.size()) - numeric).norm(), 0.05 * numeric.norm());
}

TEST(WalkEquations, TheMatrixOfJerksAndAccelerationsIsTheChangeOfTheirGradient) {
  constexpr double kStep = 1e-3;
  const Eigen::Vector2d sigma(0.2, 0.5);
  const ScanEquations none(0);
  const std::vector<ScanMotion> motions;
  const auto equations_of = [&](const GuidedPath& path) {
    WalkEquations equations(none, motions, path);
    equations.add_jerks(sigma);
    equations.add_accelerations(2 * sigma);
    return equations;
  };
  const GuidedPath path = path_of(std::nullopt);
  const Eigen::MatrixXd matrix = equations_of(path).matrix().selfadjointView<Eigen::Lower>();
  for (const Eigen::Index unknown : {0, 5, 30, 62, 100}) {
    const GuidedPath after = moved(path, unknown, kStep), before = moved(path, unknown, -kStep);
    const Eigen::VectorXd numeric =
        (equations_of(after).gradient() - equations_of(before).gradient()) / (2 * kStep);
    EXPECT_LT((matrix.col(unknown) - numeric).norm(), 0.05 * numeric.norm()) << unknown;
  }
}

// Matches that each depend on three scans, some of them on two of one knot.
struct Matches {
  ScanEquations scans;
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
};

Matches matches_of(const GuidedPath& path, const std::vector<ScanMotion>& motions,
                   const std::function<double(std::uint32_t match)>& weight_of) {
  const auto last = Eigen::Index(6 * path.blocks());
  Matches sum{ScanEquations(motions.size()), Eigen::MatrixXd::Zero(last + 1, last + 1),
              Eigen::VectorXd::Zero(last + 1)};
  const auto count = static_cast<std::uint32_t>(motions.size());
  for (std::uint32_t i = 0; i < 3 * count; ++i) {
    const double residual = 0.01 * std::sin(3.0 * i), weight = weight_of(i);
    ScanRow row;
    double slope = 0;
    const auto add = [&](std::uint32_t scan, double share) {
      const Vector3d p_m = kPoint_m + Vector3d(std::sin(i), std::cos(2.0 * i), 0.1 * scan);
      slope += row.add_point(scan, motions[scan], p_m, kNormal, share);
    };
    add(i % count, 1);
    add((i * 7 + 3) % count, -0.4);
    add((i * 5 + 1) % count, -0.6);
    sum.scans.add(row, slope, residual, weight);
    Eigen::VectorXd whole(last + 1);
    whole << dense(row, motions, path), slope;
    sum.matrix += weight * whole * whole.transpose();
    sum.gradient += weight * residual * whole;
  }
  return sum;
}

std::vector<ScanMotion> motions_along(const GuidedPath& path) {
  std::vector<ScanMotion> motions;
  for (int i = 0; i < 40; ++i) motions.push_back(scan_at(path, 2.05 + 0.035 * i));
  return motions;
}

// The equations of some matches, and what they come to without taking them apart.
struct Whole {
  Whole(const GuidedPath& path, const std::function<double(std::uint32_t match)>& weight_of)
      : motions(motions_along(path)),
        matches(matches_of(path, motions, weight_of)),
        equations(matches.scans, motions, path) {
    constexpr double kFirst = 0.01, kKnot = 0.5, kOffsetSigma_s = 0.02;
    equations.hold(kFirst, kKnot, kOffsetSigma_s);
    Eigen::MatrixXd matrix = matches.matrix;
    const auto last = Eigen::Index(6 * path.blocks());
    matrix.diagonal().head(last).array() += 1 / (kKnot * kKnot);
    if (path.knots() > 0) matrix.diagonal().head<6>().array() += 1 / (kFirst * kFirst);
    matrix(last, last) += 1 / (kOffsetSigma_s * kOffsetSigma_s);
    inverse = matrix.inverse();
    step = -inverse * matches.gradient;
  }
  std::vector<ScanMotion> motions;
  Matches matches;
  WalkEquations equations;
  Eigen::VectorXd step;
  Eigen::MatrixXd inverse;
};

void expect_solution(const WalkEquations::Solution& found, const Whole& whole, const GuidedPath& path,
                     double tolerance, double influence_tolerance) {
  const Eigen::Index last = whole.step.size() - 1;
  EXPECT_NEAR(found.offset_step_s, whole.step[last], tolerance * std::abs(whole.step[last]));
  const double sigma_s = std::sqrt(whole.inverse(last, last));
  EXPECT_NEAR(std::sqrt(found.influence[last]), sigma_s, std::max(1e-9, tolerance * sigma_s));
  EXPECT_LT((found.influence - whole.inverse.col(last)).norm(),
            influence_tolerance * whole.inverse.col(last).norm());
  ASSERT_EQ(found.block_steps.size(), path.blocks());
  for (std::size_t k = 0; k < path.blocks(); ++k)
    EXPECT_LT((found.block_steps[k] - whole.step.segment<6>(Eigen::Index(6 * k))).norm(),
              tolerance * whole.step.norm());
  if (const auto block = path.shift_block()) {
    const auto column = whole.inverse.col(Eigen::Index(6 * *block));
    EXPECT_LT((found.shift_influence - column).norm(), influence_tolerance * column.norm());
  }
}

double usual_weight(std::uint32_t match) {
  return 1 + 0.1 * match;
}

TEST_P(WalkEquationsOf, TheSolutionIsThatOfTheWholeMatrix) {
  const GuidedPath path = path_of(GetParam());
  const Whole whole(path, usual_weight);
  const Eigen::VectorXd& gradient = whole.matches.gradient;
  EXPECT_LT((whole.equations.gradient() - gradient).norm(), 1e-10 * gradient.norm());
  std::optional<WalkEquations::Factor> factor;
  const auto solution = whole.equations.solve({true, path.shift_block()}, factor);
  ASSERT_TRUE(solution);
  expect_solution(*solution, whole, path, 1e-9, 1e-8);
}

TEST_P(WalkEquationsOf, AProductIsThatOfTheMatrix) {
  const GuidedPath path = path_of(GetParam());
  Whole whole(path, usual_weight);
  whole.equations.add_jerks({0.2, 0.5});
  whole.equations.add_accelerations({0.1, 0.3});
  Eigen::VectorXd steps(whole.step.size());
  for (Eigen::Index i = 0; i < steps.size(); ++i) steps[i] = std::sin(double(i * i));
  const Eigen::VectorXd product = whole.equations.matrix().selfadjointView<Eigen::Lower>() * steps;
  EXPECT_LT((whole.equations.product(steps) - product).norm(), 1e-12 * product.norm());
}

TEST_P(WalkEquationsOf, ALongPathIsSolvedForToAHundredth) {
  const GuidedPath path = path_of(GetParam());
  Whole whole(path, usual_weight);
  whole.equations.add_jerks({0.2, 0.5});
  whole.equations.add_accelerations({0.1, 0.3});
  const auto solution = whole.equations.solve_long();
  ASSERT_TRUE(solution);
  Eigen::VectorXd steps(whole.step.size());
  for (std::size_t k = 0; k < solution->block_steps.size(); ++k)
    steps.segment<6>(Eigen::Index(6 * k)) = solution->block_steps[k];
  steps[steps.size() - 1] = solution->offset_step_s;
  const Eigen::VectorXd& gradient = whole.equations.gradient();
  EXPECT_LT((whole.equations.product(steps) + gradient).norm(), 0.011 * gradient.norm());
}

TEST_P(WalkEquationsOf, AMatchChangesByItsRow) {
  const GuidedPath path = path_of(GetParam());
  const Whole whole(path, usual_weight);
  const ScanEquations& matches = whole.matches.scans;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(whole.step.size());
  for (Eigen::Index i = 0; i < sum.size(); ++i) {
    const Eigen::VectorXd step = Eigen::VectorXd::Unit(sum.size(), i);
    const std::vector<double> changes = matches.changes(by_scans(step, whole.motions, path));
    ASSERT_EQ(changes.size(), matches.matches().size());
    for (std::size_t k = 0; k < changes.size(); ++k)
      sum[i] += changes[k] * matches.matches()[k].weight * matches.matches()[k].residual;
  }
  EXPECT_LT((sum - whole.matches.gradient).norm(), 1e-10 * sum.norm());
}

TEST_P(WalkEquationsOf, AnEarlierFactorSolvesSimilarEquationsAndIsReplacedForOthers) {
  const GuidedPath path = path_of(GetParam());
  std::optional<WalkEquations::Factor> factor;
  ASSERT_TRUE(Whole(path, usual_weight).equations.solve({}, factor));
  const Eigen::MatrixXd earlier = factor->matrixLLT();

  const Whole similar(path, [](std::uint32_t i) { return usual_weight(i) * (1 + 0.2 * std::sin(5.0 * i)); });
  const auto near = similar.equations.solve({true, path.shift_block()}, factor);
  ASSERT_TRUE(near);
  const bool few = path.knots() == 0;  // unknowns: solved with a factor of their own
  EXPECT_EQ(factor->matrixLLT() == earlier, !few);
  expect_solution(*near, similar, path, few ? 1e-9 : 0.01, few ? 1e-8 : 0.01);

  const Whole other(path, [](std::uint32_t i) { return std::exp(12 * std::sin(5.0 * i)); });
  const auto exact = other.equations.solve({true, path.shift_block()}, factor);
  ASSERT_TRUE(exact);
  EXPECT_NE(factor->matrixLLT(), earlier);
  expect_solution(*exact, other, path, 1e-6, 1e-6);
}

}  // namespace
}  // namespace sweepscope
