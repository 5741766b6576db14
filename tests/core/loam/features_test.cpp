#include "core/loam/features.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kDegree;
using test::kPi;

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr double kStep_rad = 0.25 * kDegree;

// One scan line of 721 beams from -90 to 90 deg, rolled by the motor.
Recording scan_line(const std::function<double(double angle_rad)>& range_m, double noise_m = 0) {
  Recording recording;
  recording.scans.push_back({0, 1.736e-5, -kPi / 2, kStep_rad, 0, 721});
  simulation::Random random(3, 9, 0);
  for (int i = 0; i < 721; ++i)
    recording.ranges_m.push_back(float(range_m(-kPi / 2 + i * kStep_rad) + noise_m * random.normal()));
  return recording;
}

FeatureSet features_of(const Recording& recording) {
  return extract_features(recording, FeatureOptions(), Job()).value();
}

double angle_rad(const Feature& feature) {
  return -kPi / 2 + feature.beam * kStep_rad;
}

double flat_wall_m(double angle_rad) {
  return std::abs(angle_rad) < 1.4 ? 3 / std::cos(angle_rad) : kNothing;
}

bool same(const FeatureList& l, const FeatureList& r) {
  const auto equal = [](const Feature& a, const Feature& b) {
    return a.p_in_motor_m == b.p_in_motor_m && a.range_m == b.range_m && a.time_s == b.time_s &&
           a.scan == b.scan && a.beam == b.beam && a.sharp == b.sharp;
  };
  return l.scan_begin == r.scan_begin &&
         std::equal(l.features.begin(), l.features.end(), r.features.begin(), r.features.end(), equal);
}

TEST(Features, AFlatWallHasPlanePointsThatLieOnItAndNoCorner) {
  const FeatureSet set = features_of(scan_line(flat_wall_m, 0.01));
  EXPECT_GT(set.planes.features.size(), 40u);
  for (const Feature& feature : set.planes.features) EXPECT_NEAR(feature.p_in_motor_m.x(), 3, 0.03);
  for (const Feature& feature : set.edges.features) EXPECT_GT(std::abs(angle_rad(feature)), 1.37);
}

TEST(Features, SomeButNotAllPlanePointsAreToBeMatched) {
  const FeatureSet set = features_of(scan_line(flat_wall_m, 0.01));
  const auto sharp = std::count_if(set.planes.features.begin(), set.planes.features.end(),
                                   [](const Feature& f) { return f.sharp; });
  EXPECT_GT(sharp, 10);
  EXPECT_LT(sharp, std::ssize(set.planes.features) / 2);
}

TEST(Features, ACornerIsAnEdge) {
  const double corner_rad = std::atan2(2, 3);
  const FeatureSet set = features_of(scan_line([&](double angle_rad) {
    return angle_rad < corner_rad ? flat_wall_m(angle_rad) : 2 / std::sin(angle_rad);
  }));
  const auto at_corner = [&](const Feature& f) {
    return std::abs(angle_rad(f) - corner_rad) < 1.5 * kStep_rad;
  };
  const auto& edges = set.edges.features;
  ASSERT_EQ(std::count_if(edges.begin(), edges.end(), at_corner), 1);
  EXPECT_TRUE(std::find_if(edges.begin(), edges.end(), at_corner)->sharp);
  for (const Feature& plane : set.planes.features)
    EXPECT_GT(std::abs(angle_rad(plane) - corner_rad), 2 * kStep_rad);
}

// A post 2 m away stands before a wall 4 m away.
class Occlusion : public testing::Test {
 protected:
  static bool on_post(double angle_rad) { return angle_rad > 0.2 && angle_rad < 0.5; }
  FeatureSet set_ = features_of(scan_line(
      [](double angle_rad) { return on_post(angle_rad) ? 2.0 : flat_wall_m(angle_rad) * 4 / 3; }, 0.005));
};

TEST_F(Occlusion, TheNearersLastPointsAreEdges) {
  for (const double end_rad : {0.2, 0.5}) {
    const auto ends = [&](const Feature& f) {
      return f.range_m < 2.1f && std::abs(angle_rad(f) - end_rad) < kStep_rad;
    };
    EXPECT_EQ(std::count_if(set_.edges.features.begin(), set_.edges.features.end(), ends), 1) << end_rad;
  }
}

TEST_F(Occlusion, TheFarthersPointsBesideItAreNot) {
  for (const Feature& feature : set_.edges.features)
    EXPECT_FALSE(feature.range_m > 3 && angle_rad(feature) > 0.1 && angle_rad(feature) < 0.6)
        << angle_rad(feature);
}

TEST(Features, ASurfaceThatEndsBeforeTheSkyEndsInAnEdge) {
  const FeatureSet set = features_of(
      scan_line([](double angle_rad) { return angle_rad < 0.3 ? flat_wall_m(angle_rad) : kNothing; }, 0.005));
  const auto ends = [&](const Feature& f) { return std::abs(angle_rad(f) - 0.3) < kStep_rad; };
  EXPECT_EQ(std::count_if(set.edges.features.begin(), set.edges.features.end(), ends), 1);
}

// A wall that goes on beyond the 10 m that are seen, and one that ends at 4 m before the sky.
TEST(Features, AWallThatGoesOnBeyondTheReachOfTheScannerHasNoEdgeThere) {
  constexpr double kReach_m = 10;
  const FeatureSet set = features_of(scan_line(
      [](double angle_rad) {
        const double range_m = angle_rad < 0 ? 4 / std::cos(angle_rad + 0.5) : 5 / std::cos(angle_rad);
        return (angle_rad > -0.3 && angle_rad < 0.3) || range_m > kReach_m ? kNothing : range_m;
      },
      0.005));
  const auto edges_at = [&](double at_rad) {
    return std::ranges::count_if(set.edges.features, [&](const Feature& feature) {
      return std::abs(angle_rad(feature) - at_rad) < 2 * kStep_rad;
    });
  };
  EXPECT_EQ(edges_at(-0.3), 1);
  EXPECT_EQ(edges_at(0.3), 1);
  EXPECT_EQ(edges_at(std::acos(0.5)), 0);
}

TEST(Features, ASingleBeamThatReturnsNothingIsNotTheSky) {
  const FeatureSet set = features_of(scan_line(
      [](double angle_rad) {
        return std::abs(angle_rad - 0.3) < 0.6 * kStep_rad ? kNothing : flat_wall_m(angle_rad);
      },
      0.005));
  for (const Feature& feature : set.edges.features) EXPECT_GT(std::abs(angle_rad(feature) - 0.3), 0.1);
}

TEST(Features, BeamsThatReturnNothingGiveNothing) {
  const FeatureSet none = features_of(scan_line([](double) { return kNothing; }));
  EXPECT_TRUE(none.edges.features.empty());
  EXPECT_TRUE(none.planes.features.empty());
}

TEST(Features, BeamsLostByChanceCostFewPlanePointsAndMakeNoEdges) {
  const std::size_t of_all = features_of(scan_line(flat_wall_m, 0.01)).planes.features.size();
  for (const double lost : {0.05, 0.1, 0.3, 0.5}) {
    simulation::Random random(5, 11, 0);
    Recording recording = scan_line(flat_wall_m, 0.01);
    for (float& range_m : recording.ranges_m)
      if (random.uniform() < lost) range_m = kNothing;
    const FeatureSet set = features_of(recording);
    EXPECT_GT(set.planes.features.size(), of_all * 2 / 3) << lost;
    for (const Feature& feature : set.planes.features) {
      EXPECT_TRUE(std::isfinite(recording.ranges_m[feature.beam])) << lost << ": it was measured";
      EXPECT_NEAR(feature.p_in_motor_m.x(), 3, 0.04) << lost;
    }
    for (const Feature& feature : set.edges.features) EXPECT_GT(std::abs(angle_rad(feature)), 1.3) << lost;
  }
}

TEST(Features, HolesWhereNothingCanBeSeenAreNotBridged) {
  // Every second window looks through: no beam is lost by chance, and the frames between end in edges.
  const FeatureSet set = features_of(scan_line(
      [](double angle_rad) {
        return std::fmod(angle_rad + 9, 0.3) < 0.15 ? kNothing : flat_wall_m(angle_rad);
      },
      0.005));
  EXPECT_GT(set.edges.features.size(), 10u);
  EXPECT_GT(set.planes.features.size(), 20u);
}

TEST(Features, BeamsAlongTheMotorsAxisAreLeftOut) {
  const auto nearest_to_axis_rad = [](const Eigen::Vector3d& motor_axis) {
    Recording recording = scan_line(flat_wall_m, 0.01);
    recording.rig.mount.axis = motor_axis;
    double nearest_rad = 9;
    for (const Feature& feature : features_of(recording).planes.features)
      nearest_rad = std::min(nearest_rad, std::abs(angle_rad(feature)));
    return nearest_rad;
  };
  EXPECT_GE(nearest_to_axis_rad(Eigen::Vector3d::UnitX()), std::asin(0.05) - 1e-6);
  EXPECT_LT(nearest_to_axis_rad(Eigen::Vector3d::UnitZ()), 0.02);  // a yawing motor turns every beam
}

TEST(Features, TheRangeNoiseIsFoundWithinAFifth) {
  for (const double noise_m : {0.010, 0.030}) {
    SimulationOptions options;
    options.noise_m = noise_m;
    options.duration_s = 1.0;
    EXPECT_NEAR(estimate_range_noise_m(simulate(options, Job()).value().recording) / noise_m, 1, 0.2);
  }
}

TEST(Features, DoNotDependOnTheMotorsClock) {
  const FeatureSet here = features_of(test::room(0.024));
  const FeatureSet there = features_of(test::room(-0.008));
  EXPECT_TRUE(same(here.edges, there.edges));
  EXPECT_TRUE(same(here.planes, there.planes));
}

TEST(Features, AreTheSameForOneAndTwoThreads) {
  FeatureSet one;
  {
    const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
    one = features_of(test::room(0.024));
  }
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  const FeatureSet many = features_of(test::room(0.024));
  EXPECT_TRUE(same(one.edges, many.edges));
  EXPECT_TRUE(same(one.planes, many.planes));
}

TEST(Features, ACancelledJobIsInterrupted) {
  Job job;
  job.cancel();
  const auto result = extract_features(scan_line(flat_wall_m), FeatureOptions(), job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::kInterrupted);
}

}  // namespace
}  // namespace sweepscope
