#include "core/geometry/pose.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kPi;

const Vector3d kAxis = Vector3d(1, -2, 3).normalized();

Pose pose(const Vector3d& rotation_rad, const Vector3d& translation_m) {
  return {rotation_from_vector(rotation_rad), translation_m};
}

const Pose kFirst = pose({0.3, -0.2, 0.9}, {1, 2, 3});
const Pose kSecond = pose({-1.1, 0.4, 0.1}, {-0.5, 0.2, 4});
const Vector3d kPoint(0.7, -1.3, 2.1);

TEST(Pose, ComposedPosesActOneAfterTheOther) {
  EXPECT_NEAR(((kFirst * kSecond) * kPoint - kFirst * (kSecond * kPoint)).norm(), 0, 1e-14);
}

TEST(Pose, TheInverseUndoesFromEitherSide) {
  EXPECT_NEAR((kFirst.inverse() * (kFirst * kPoint) - kPoint).norm(), 0, 1e-14);
  EXPECT_NEAR(((kFirst * kFirst.inverse()) * kPoint - kPoint).norm(), 0, 1e-14);
}

TEST(Pose, ALongChainOfCompositionsStaysARotation) {
  Pose chain;
  for (int i = 0; i < 100000; ++i) chain = chain * kFirst;
  EXPECT_NEAR(chain.rotation.norm(), 1, 1e-15);
}

TEST(Pose, InterpolationMeetsBothEnds) {
  EXPECT_NEAR((interpolate(kFirst, kSecond, 0) * kPoint - kFirst * kPoint).norm(), 0, 1e-14);
  EXPECT_NEAR((interpolate(kFirst, kSecond, 1) * kPoint - kSecond * kPoint).norm(), 0, 1e-14);
}

TEST(Pose, InterpolationTurnsAtAConstantRateAndGoesOnBeyondTheEnds) {
  const Pose end = pose(0.8 * kAxis, {2, 0, -4});
  for (const double u : {-0.5, 0.25, 0.5, 1.5}) {
    const Pose between = interpolate(Pose{}, end, u);
    EXPECT_NEAR((vector_from_rotation(between.rotation) - u * 0.8 * kAxis).norm(), 0, 1e-14) << u;
    EXPECT_NEAR((between.translation_m - u * Vector3d(2, 0, -4)).norm(), 0, 1e-14) << u;
  }
}

class RotationVector : public testing::TestWithParam<double> {};

TEST_P(RotationVector, IsTheRotationOfItsAxisAndAngle) {
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(GetParam(), kAxis));
  EXPECT_NEAR((rotation_from_vector(GetParam() * kAxis) * kPoint - expected * kPoint).norm(), 0, 1e-14);
}

TEST_P(RotationVector, ComesBackFromTheRotationAndFromItsNegativeQuaternion) {
  const Vector3d rotation_rad = GetParam() * kAxis;
  Eigen::Quaterniond rotation = rotation_from_vector(rotation_rad);
  EXPECT_NEAR((vector_from_rotation(rotation) - rotation_rad).norm(), 0, 1e-14 + 1e-14 * GetParam());
  rotation.coeffs() = -rotation.coeffs();
  EXPECT_NEAR((vector_from_rotation(rotation) - rotation_rad).norm(), 0, 1e-14 + 1e-14 * GetParam());
}

INSTANTIATE_TEST_SUITE_P(FromNothingToHalfATurn, RotationVector,
                         testing::Values(0.0, 1e-15, 1e-13, 1e-11, 1e-6, 1e-3, 0.5, 2.0, kPi - 1e-3,
                                         kPi - 1e-9));

TEST(RotationVectors, TinyOnesKeepTheirRelativeAccuracy) {
  for (const double angle_rad : {3e-13, 3e-12, 3e-8})
    EXPECT_NEAR(vector_from_rotation(rotation_from_vector(angle_rad * kAxis)).norm() / angle_rad, 1, 1e-12);
}

TEST(RotationVectors, MoreThanHalfATurnComesBackAsTheShorterWay) {
  const Vector3d back = vector_from_rotation(rotation_from_vector((kPi + 0.4) * kAxis));
  EXPECT_NEAR((back + (kPi - 0.4) * kAxis).norm(), 0, 1e-14);
}

}  // namespace
}  // namespace sweepscope
