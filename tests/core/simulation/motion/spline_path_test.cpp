#include "core/simulation/motion/spline_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

/// A known motion: 0.8 m/s and 1.5 rad/s at most, 1.1 Hz.
Pose known(double t_s) {
  const Vector3d p_m(0.1 * std::sin(7 * t_s), 0.3 * std::cos(2 * t_s), 1.2 + 0.02 * std::sin(5 * t_s));
  const Vector3d turned_rad(0.1 * std::sin(5 * t_s), 0.2 * std::cos(3 * t_s), 2.5 * std::sin(0.5 * t_s));
  return {p_m, rotation_from_vector(turned_rad)};
}

/// Sampled at `rate_hz`, at uneven times, with noise.
std::vector<StampedPose> sampled(double rate_hz, double duration_s, double noise_m, double noise_rad,
                                 double gap_from_s = 0, double gap_to_s = 0) {
  Random random(5, 0, 0);
  std::vector<StampedPose> poses;
  for (double i = 0; i / rate_hz < duration_s; ++i) {
    const double t_s = (i + 0.6 * random.uniform()) / rate_hz;
    const Vector3d off_m(random.normal(), random.normal(), random.normal());
    const Vector3d off_rad(random.normal(), random.normal(), random.normal());
    if (t_s > gap_from_s && t_s < gap_to_s) continue;
    const Pose pose = known(t_s);
    Eigen::Quaterniond q = pose.orientation * rotation_from_vector(noise_rad * off_rad);
    if (random.uniform() < 0.5) q.coeffs() = -q.coeffs();  // either sign is the same orientation
    poses.push_back({t_s, pose.position_m + noise_m * off_m, q});
  }
  return poses;
}

double rotation_deg(const Pose& l, const Pose& r) {
  return degrees(l.orientation.angularDistance(r.orientation));
}

TEST(SplinePath, ReproducesAKnownMotion) {
  for (const double rate_hz : {20.0, 60.0, 200.0}) {
    const auto poses = sampled(rate_hz, 10, 0, 0);
    const SplinePath path(poses, 0.05);
    for (double t_s = path.first_s(); t_s < path.last_s(); t_s += 0.0037) {
      ASSERT_LT((path.at(t_s).position_m - known(t_s).position_m).norm(), 1e-3) << rate_hz << " Hz, " << t_s;
      ASSERT_LT(rotation_deg(path.at(t_s), known(t_s)), 0.05) << rate_hz << " Hz, " << t_s;
    }
    EXPECT_LT(deviation(path, poses).position_m, 3e-4);
    EXPECT_LT(degrees(deviation(path, poses).rotation_rad), 0.02);
  }
}

TEST(SplinePath, SmoothsJitterAndSaysHowMuch) {
  const auto poses = sampled(200, 10, 0.002, radians(0.3));
  const SplinePath path(poses, 0.05);
  double off_m2 = 0, count = 0;
  for (double t_s = 0.1; t_s < 9.9; t_s += 0.01, ++count)
    off_m2 += (path.at(t_s).position_m - known(t_s).position_m).squaredNorm();
  // Ten poses to a knot: the error of the mean is about a third of a pose's.
  EXPECT_LT(std::sqrt(off_m2 / count), 0.002 * std::sqrt(3.0) / 2.2);
  EXPECT_NEAR(deviation(path, poses).position_m, 0.002 * std::sqrt(3.0), 4e-4);
  EXPECT_NEAR(degrees(deviation(path, poses).rotation_rad), 0.3 * std::sqrt(3.0), 0.06);
}

TEST(SplinePath, ItsAccelerationDoesNotJump) {
  const SplinePath path(sampled(100, 5, 0.001, 0.001), 0.05);
  constexpr double kStep_s = 1e-3;
  const auto acceleration = [&](double t_s) -> Vector3d {
    return (path.at(t_s + kStep_s).position_m - 2 * path.at(t_s).position_m +
            path.at(t_s - kStep_s).position_m) /
           (kStep_s * kStep_s);
  };
  const auto turning = [&](double t_s) -> Eigen::Vector4d {
    return (path.at(t_s + kStep_s).orientation.coeffs() - 2 * path.at(t_s).orientation.coeffs() +
            path.at(t_s - kStep_s).orientation.coeffs()) /
           (kStep_s * kStep_s);
  };
  double top_mps2 = 0, jump_mps2 = 0, turning_top = 0, turning_jump = 0;
  for (double t_s = 0.1; t_s < 4.8; t_s += kStep_s) {
    top_mps2 = std::max(top_mps2, acceleration(t_s).norm());
    jump_mps2 = std::max(jump_mps2, (acceleration(t_s + kStep_s) - acceleration(t_s)).norm());
    turning_top = std::max(turning_top, turning(t_s).norm());
    turning_jump = std::max(turning_jump, (turning(t_s + kStep_s) - turning(t_s)).norm());
  }
  // It goes from knot to knot in straight lines: 50 steps for what may be twice the greatest one.
  EXPECT_LT(jump_mps2, top_mps2 * 2.5 / 50);
  EXPECT_LT(turning_jump, turning_top * 2.5 / 50);
}

TEST(SplinePath, BridgesMissingPosesWithoutAWhip) {
  const SplinePath path(sampled(60, 6, 0.001, radians(0.4), 2.4, 2.8), 0.05);
  for (double t_s = 2.3; t_s < 2.9; t_s += 0.01) {
    EXPECT_LT((path.at(t_s).position_m - known(t_s).position_m).norm(), 0.03) << t_s;
    EXPECT_LT(rotation_deg(path.at(t_s), path.at(t_s + 0.01)), degrees(2.5 * 0.01)) << t_s;
  }
}

TEST(SplinePath, RestsBeforeItsBeginningAndAfterItsEnd) {
  const SplinePath path(sampled(100, 2, 0, 0), 0.05);
  EXPECT_EQ(path.at(path.first_s() - 3).position_m, path.at(path.first_s()).position_m);
  EXPECT_EQ(path.at(path.last_s() + 3).position_m, path.at(path.last_s()).position_m);
  EXPECT_NEAR(path.last_s(), 2, 0.02);
}

}  // namespace
}  // namespace sweepscope::simulation
