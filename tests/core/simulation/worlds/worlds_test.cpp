#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/motion/trajectory.hpp"
#include "core/simulation/scenes/free_space.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/worlds/walk.hpp"
#include "core/simulation/worlds/world.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope {
namespace {

using namespace simulation;

constexpr double kDuration_s = 25;
constexpr double kWhole_s = 60;  // of which a calm walk may stand for a third

class Worlds : public testing::TestWithParam<std::string_view> {
 protected:
  static World world(std::uint64_t seed) { return make_world(GetParam(), seed).value(); }
  static RecordedPath walk(const World& world, const WalkStyle& style, std::uint64_t seed,
                           double duration_s = kDuration_s) {
    const auto path = make_walk(world, style, seed, duration_s);
    EXPECT_TRUE(path.has_value()) << GetParam() << ':' << seed << ' ' << style.name;
    return path.value();  // throws
  }
};

TEST_P(Worlds, KeepEveryWalkClearOfTheirSurfacesAndOnTheirFloor) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const World place = world(seed);
    const RayCaster caster(place.mesh);
    for (const WalkStyle& style : walk_styles()) {
      const RecordedPath path = walk(place, style, seed);
      const auto laser_at = [&](double t_s) { return path.at(t_s).position_m; };
      EXPECT_TRUE(check_free_space(caster, laser_at, kDuration_s)) << GetParam() << ':' << seed;
      for (double t_s = 0; t_s <= kDuration_s; t_s += 0.05) {
        const Vector3d p_m = laser_at(t_s);
        ASSERT_FALSE(caster.distance_m(p_m, 0.28)) << GetParam() << ':' << seed << " at " << t_s << " s";
        ASSERT_TRUE(caster.cast(p_m, -Vector3d::UnitZ(), 2.2))
            << GetParam() << ':' << seed << " at " << t_s << " s";
      }
    }
  }
}

TEST_P(Worlds, AreWalkedWithinTheBoundsOfTheStyle) {
  const std::vector<std::pair<double, double>> bounds{{1.1, 40}, {1.75, 60}, {2.2, 100}};  // m/s, deg/s
  for (std::uint64_t seed = 4; seed <= 6; ++seed) {
    const World place = world(seed);
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const RecordedPath path = walk(place, walk_styles()[i], seed, kWhole_s);
      const WalkMeasure measured = measure([&](double t_s) { return path.at(t_s); }, 0, kWhole_s);
      EXPECT_LE(measured.top_speed_mps, bounds[i].first) << GetParam() << ':' << seed;
      EXPECT_LE(degrees(measured.top_angular_rate_radps), bounds[i].second) << GetParam() << ':' << seed;
      EXPECT_GT(measured.length_m, 0.25 * kWhole_s) << GetParam() << ':' << seed;
      EXPECT_EQ(path.duration_s, kWhole_s);
    }
  }
}

TEST_P(Worlds, AreTheSameForTheSameSeedAndDifferForOthers) {
  const auto corners = [](const World& place) {
    std::vector<double> all;
    for (const Triangle& t : place.mesh.triangles)
      all.insert(all.end(), {t.a.x(), t.b.y(), t.c.z(), t.albedo});
    return all;
  };
  const auto positions = [](const RecordedPath& path) {
    std::vector<double> all;
    for (double t_s = 0; t_s < kDuration_s; t_s += 1) all.push_back(path.at(t_s).position_m.sum());
    return all;
  };
  const World one = world(1), again = world(1), other = world(2);
  EXPECT_EQ(corners(one), corners(again));
  EXPECT_NE(corners(one), corners(other));
  const WalkStyle brisk = walk_style("brisk").value();
  EXPECT_EQ(positions(walk(one, brisk, 1)), positions(walk(again, brisk, 1)));
  EXPECT_NE(positions(walk(one, brisk, 1)), positions(walk(one, brisk, 2)));
}

TEST_P(Worlds, AreAsLargeAsPlacesOfTheirName) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Vector2d size_m = world(seed).walked_m.sizes();
    EXPECT_GE(size_m.maxCoeff(), GetParam() == "stairs" ? 6 : 20) << GetParam() << ':' << seed;
    EXPECT_LE(size_m.maxCoeff(), 150) << GetParam() << ':' << seed;
    EXPECT_GE(size_m.minCoeff(), GetParam() == "stairs" ? 3 : 12) << GetParam() << ':' << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Worlds, testing::ValuesIn(world_names()), [](const auto& world) {
  std::string name(world.param);
  std::erase(name, '-');
  return name;
});

TEST(WorldWalks, SomeReturnAndOthersDoNotSomeBeginAtRestAndOthersInMotion) {
  const World place = make_world("hall", 3).value();
  int returned = 0, rested = 0;
  constexpr int kWalks = 20;
  for (std::uint64_t seed = 1; seed <= kWalks; ++seed) {
    const auto path = make_walk(place, walk_style("calm").value(), seed, 60).value();
    returned += (path.at(60).position_m - path.at(0).position_m).norm() < 0.6;
    rested += (path.at(0.5).position_m - path.at(0).position_m).norm() < 0.05;
  }
  EXPECT_GE(returned, 4);
  EXPECT_LE(returned, kWalks - 4);
  EXPECT_GE(rested, 4);
  EXPECT_LE(rested, kWalks - 4);
}

TEST(WorldWalks, ClimbStairs) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const World place = make_world("stairs", seed).value();
    const auto path = make_walk(place, walk_style("brisk").value(), seed, 60).value();
    double low_m = 1e9, high_m = -1e9;
    for (double t_s = 0; t_s < 60; t_s += 0.2) {
      low_m = std::min(low_m, path.at(t_s).position_m.z());
      high_m = std::max(high_m, path.at(t_s).position_m.z());
    }
    EXPECT_GT(high_m - low_m, 2.5) << seed;
  }
}

TEST(WorldWalks, WildOnesStopOnTheWay) {
  const World place = make_world("yard", 1).value();
  const auto path = make_walk(place, walk_style("wild").value(), 5, 60).value();
  double slowest_m = 1;  // covered in a second, swings included
  for (double t_s = 6; t_s < 55; t_s += 0.5)
    slowest_m = std::min(slowest_m, (path.at(t_s + 1).position_m - path.at(t_s).position_m).norm());
  EXPECT_LT(slowest_m, 0.25);
}

class SimulatedWorlds : public testing::Test {
 protected:
  static SimulationOptions options(const std::string& world, std::uint64_t seed) {
    SimulationOptions asked;
    asked.duration_s = 5;
    asked.random = {world, "calm", seed, seed};
    return asked;
  }
  static std::string refused(const SimulationOptions& asked) {
    const auto simulation = simulate(asked, Job());
    EXPECT_FALSE(simulation);
    if (simulation) return "";
    EXPECT_EQ(simulation.error().code, ExitCode::kWrongUsage);
    return simulation.error().message;
  }
};

TEST_F(SimulatedWorlds, HaveTheSameBytesForTheSameSeedAndTheirTruth) {
  const auto one = simulate(options("corridor", 1), Job()), again = simulate(options("corridor", 1), Job()),
             other = simulate(options("corridor", 2), Job());
  ASSERT_TRUE(one && again && other);
  EXPECT_TRUE(std::ranges::equal(one->recording.intensities, again->recording.intensities));
  EXPECT_FALSE(std::ranges::equal(one->recording.intensities, other->recording.intensities));
  EXPECT_EQ(truth_tum(*one), truth_tum(*again));
  EXPECT_TRUE(one->moving);
  EXPECT_EQ(one->recording.scans.size(), 200U);
  EXPECT_NE(truth_json(*one).find(R"("world": "corridor")"), std::string::npos) << truth_json(*one);
  EXPECT_NEAR(one->truth.back().time_s, 5, 1e-9);
}

TEST_F(SimulatedWorlds, NameTheChoicesForAnUnknownWorldOrWalk) {
  EXPECT_NE(refused(options("castle", 1)).find("the worlds are yard, forest, street"), std::string::npos);
  SimulationOptions asked = options("yard", 1);
  asked.random.walk = "slow";
  EXPECT_NE(refused(asked).find("the walks are calm, brisk, wild, stand"), std::string::npos);
}

TEST_F(SimulatedWorlds, HaveAPlaceForARigThatStands) {
  for (const std::string_view world : world_names()) {
    SimulationOptions asked = options(std::string(world), 3);
    asked.random.walk = "stand";
    asked.duration_s = 1;
    const auto made = simulate(asked, Job());
    ASSERT_TRUE(made) << world << ": " << made.error().message;
    EXPECT_FALSE(made->moving) << world;
    EXPECT_EQ(made->recording.scans.size(), 40U) << world;
    EXPECT_GT(made->truth.front().position_m.norm(), 0) << world;
  }
}

TEST_F(SimulatedWorlds, LastFiveSecondsToTenMinutes) {
  for (const double duration_s : {4.0, 601.0}) {
    SimulationOptions asked = options("yard", 1);
    asked.duration_s = duration_s;
    EXPECT_NE(refused(asked).find("last 5 to 600 s"), std::string::npos);
  }
}

}  // namespace
}  // namespace sweepscope
