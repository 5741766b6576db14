#include "core/loam/path/path_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

const Vector3d kTurnedAbout(0.4, -0.2, 0.1);

std::vector<Pose> path() {
  std::vector<Pose> knots;
  for (int i = 0; i < 4; ++i)
    knots.push_back({rotation_from_vector({0.02 * i, 0.01 * i * i, -0.03}), {0.1 * i, 0.02 * i * i, 0.3}});
  return knots;
}

// The gradient of half a sum of squares by steps of the knots, by central differences.
Eigen::VectorXd numeric_gradient(const std::function<double(const std::vector<Pose>&)>& cost) {
  constexpr double kStep = 1e-5;
  const std::vector<Pose> knots = path();
  Eigen::VectorXd gradient(Eigen::Index(6 * knots.size()));
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    const auto at = [&](double step) {
      std::vector<Pose> moved = knots;
      Pose& knot = moved[std::size_t(i / 6)];
      knot = stepped(knot, step * Vector6d::Unit(i % 6), kTurnedAbout);
      return cost(moved);
    };
    gradient[i] = (at(kStep) - at(-kStep)) / (2 * kStep);
  }
  return gradient;
}

double half_square(const Vector6d& residual, double rotation_sigma, double translation_sigma) {
  return residual.head<3>().squaredNorm() / (2 * rotation_sigma * rotation_sigma) +
         residual.tail<3>().squaredNorm() / (2 * translation_sigma * translation_sigma);
}

TEST(PathEquations, APointsRowActsOnTheTwoKnotsBesideIt) {
  PathEquations equations(4, 0.6);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(24, 24);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(24);
  for (const double u : {0.0, 0.05, 0.31, 0.6, 0.62}) {
    const Vector6d row = distance_jacobian({1 + u, 2, -1}, Vector3d(1, 2, u).normalized(), kTurnedAbout);
    equations.add(u, row, 0.3 - u, 2.0);
    const double place = u / 0.2;
    const auto knot = std::min<Eigen::Index>(2, Eigen::Index(place));
    Eigen::VectorXd shared = Eigen::VectorXd::Zero(24);
    shared.segment<6>(6 * knot) = (1 - (place - double(knot))) * row;
    shared.segment<6>(6 * knot + 6) = (place - double(knot)) * row;
    matrix += 2.0 * shared * shared.transpose();
    gradient += 2.0 * (0.3 - u) * shared;
  }
  EXPECT_NEAR((equations.matrix() - matrix).norm(), 0, 1e-11);
  EXPECT_NEAR((equations.gradient() - gradient).norm(), 0, 1e-12);
}

TEST(PathEquations, AccelerationsHaveTheGradientOfTheirSquares) {
  const Pose before{rotation_from_vector({-0.03, 0, 0.01}), {-0.2, 0, 0.3}};
  PathEquations equations(4, 1);
  equations.add_accelerations(path(), before, {0.2, 0.5}, kTurnedAbout);
  const Eigen::VectorXd numeric = numeric_gradient([&](const std::vector<Pose>& knots) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      sum += half_square(
          difference(knots[i + 1], knots[i]) - difference(knots[i], i > 0 ? knots[i - 1] : before), 0.2, 0.5);
    return sum;
  });
  EXPECT_LT((equations.gradient() - numeric).norm(), 0.05 * numeric.norm());
}

// With a given motion, differences are taken from where it leads.
TEST(PathEquations, DeviationsFromAGivenMotionHaveTheGradientOfTheirSquares) {
  const Pose before{rotation_from_vector({-0.03, 0, 0.01}), {-0.2, 0, 0.3}};
  std::vector<Pose> moves;
  for (int i = 0; i < 4; ++i)
    moves.push_back({rotation_from_vector({0.03, -0.02 * i, 0.1}), {0.08, 0.03 * i, -0.05}});
  PathEquations equations(4, 1);
  equations.add_accelerations(path(), before, {0.2, 0.5}, kTurnedAbout, moves);
  equations.add_velocities(path(), 0.7, kTurnedAbout, moves);
  const Eigen::VectorXd numeric = numeric_gradient([&](const std::vector<Pose>& knots) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const Vector6d last = difference(knots[i], (i > 0 ? knots[i - 1] : before) * moves[i]);
      const Vector6d next = difference(knots[i + 1], knots[i] * moves[i + 1]);
      sum += half_square(next - last, 0.2, 0.5) + half_square(next, 0.7, 0.7);
    }
    return sum;
  });
  EXPECT_LT((equations.gradient() - numeric).norm(), 0.05 * numeric.norm());
}

TEST(PathEquations, VelocitiesAndTheTieHaveTheGradientOfTheirSquares) {
  const Pose given{rotation_from_vector({0.01, 0.02, 0}), {0.05, 0.1, 0.2}};
  PathEquations equations(4, 1);
  equations.add_velocities(path(), 0.7, kTurnedAbout);
  equations.add_tie(path().front(), given, 0.3, kTurnedAbout);
  const Eigen::VectorXd numeric = numeric_gradient([&](const std::vector<Pose>& knots) {
    double sum = half_square(difference(knots[0], given), 0.3, 0.3);
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      sum += half_square(difference(knots[i + 1], knots[i]), 0.7, 0.7);
    return sum;
  });
  EXPECT_LT((equations.gradient() - numeric).norm(), 0.05 * numeric.norm());
}

TEST(PathEquations, TheSolutionLeadsToTheLeastSquares) {
  const Pose given{rotation_from_vector({0.01, 0.02, 0}), {0.05, 0.1, 0.2}};
  std::vector<Pose> knots = path();
  for (int i = 0; i < 5; ++i) {
    PathEquations equations(4, 1);
    equations.add_velocities(knots, 0.7, kTurnedAbout);
    equations.add_tie(knots.front(), given, 0.3, kTurnedAbout);
    const std::vector<Vector6d> steps = equations.solve();
    for (std::size_t k = 0; k < knots.size(); ++k) knots[k] = stepped(knots[k], steps[k], kTurnedAbout);
  }
  for (const Pose& knot : knots) EXPECT_LT(difference(knot, given).norm(), 1e-6);
}

TEST(PathEquations, TheStepsSolveTheEquations) {
  constexpr std::size_t kKnots = 7;
  PathEquations equations(kKnots, 1);
  for (int i = 0; i < 60; ++i) {
    const double u = i / 59.0, turn = 2.4 * i;
    const Vector3d normal(std::cos(turn), std::sin(turn), std::sin(0.7 * turn));
    equations.add(u, distance_jacobian({3 + u, std::cos(i), 1}, normal.normalized(), kTurnedAbout),
                  0.1 * std::sin(3.0 * i), 1 + u);
  }
  std::vector<Pose> knots = path();
  while (knots.size() < kKnots) knots.push_back(knots.back() * knots[1]);
  equations.add_accelerations(knots, knots[0], {0.2, 0.5}, kTurnedAbout);
  equations.add_velocities(knots, 0.7, kTurnedAbout);
  equations.add_tie(knots[0], Pose(), 0.3, kTurnedAbout);
  Eigen::VectorXd steps(Eigen::Index(6 * kKnots));
  const std::vector<Vector6d> solved = equations.solve();
  ASSERT_EQ(solved.size(), kKnots);
  for (std::size_t i = 0; i < kKnots; ++i) steps.segment<6>(Eigen::Index(6 * i)) = solved[i];
  EXPECT_LT((equations.matrix() * steps + equations.gradient()).norm(), 1e-9 * equations.gradient().norm());
}

}  // namespace
}  // namespace sweepscope
