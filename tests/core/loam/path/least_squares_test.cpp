#include "core/loam/path/least_squares.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

const Vector3d kPivot(1, -2, 0.5), kNormal = Vector3d(2, 1, -1).normalized();
const Vector3d kPoint(3, 0.4, -1);

Vector6d twist(double a, double b, double c, double d, double e, double f) {
  Vector6d step;
  step << a, b, c, d, e, f;
  return step;
}

// An orthonormal basis of nothing in particular.
Matrix6d basis() {
  Matrix6d m;
  for (int i = 0; i < 36; ++i) m(i / 6, i % 6) = std::sin(1.7 * i * i + 0.3);
  return m.householderQr().householderQ();
}

TEST(LeastSquares, ADeterminedMinimumIsFound) {
  const Vector6d scale = twist(1, 2, 3, 4, 5, 6), least = twist(1, -1, 2, -2, 3, -3);
  const Matrix6d a = basis() * scale.asDiagonal() * basis().transpose();
  int free_directions = -1;
  EXPECT_NEAR((solve_determined(a, -a * least, 1e-3, free_directions) - least).norm(), 0, 1e-12);
  EXPECT_EQ(free_directions, 0);
}

TEST(LeastSquares, DirectionsThatNothingDeterminesAreLeftAlone) {
  const Matrix6d q = basis();
  const Matrix6d a = q * twist(1e-9, 1, 1, 0, 1, 1).asDiagonal() * q.transpose();
  const Vector6d g = q * twist(1, 1, 1, 1, 1, 1);
  int free_directions = -1;
  const Vector6d step = solve_determined(a, g, 1e-3, free_directions);
  EXPECT_EQ(free_directions, 2);
  EXPECT_NEAR((q.transpose() * step - twist(0, -1, -1, 0, -1, -1)).norm(), 0, 1e-12);
}

TEST(LeastSquares, TheJacobianIsTheDistancesDerivative) {
  constexpr double kStep = 1e-6;
  const auto distance_m = [](const Vector6d& step) {
    return (stepped(Pose{}, step, kPivot) * kPoint).dot(kNormal);
  };
  const Vector6d row = distance_jacobian(kPoint, kNormal, kPivot);
  for (int i = 0; i < 6; ++i) {
    const Vector6d step = kStep * Vector6d::Unit(i);
    EXPECT_NEAR((distance_m(step) - distance_m(-step)) / (2 * kStep), row[i], 1e-8) << i;
  }
}

TEST(LeastSquares, AStepTurnsAboutItsPivot) {
  const Pose pose{rotation_from_vector({0.3, 0.1, -0.2}), {4, 5, 6}};
  const Pose turned = stepped(pose, twist(0.2, -0.4, 0.1, 0, 0, 0), kPivot);
  EXPECT_NEAR((turned * (pose.inverse() * kPivot) - kPivot).norm(), 0, 1e-14);
}

TEST(LeastSquares, AWideResidualWeighsLess) {
  EXPECT_DOUBLE_EQ(cauchy_weight(0, 0.1), 1);
  EXPECT_DOUBLE_EQ(cauchy_weight(-0.1, 0.1), 0.5);
  EXPECT_NEAR(cauchy_weight(10, 0.1), 1e-4, 1e-6);
}

}  // namespace
}  // namespace sweepscope
