#include "core/simulation/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/meshes/ray_caster.hpp"
#include "core/simulation/motion/trajectory.hpp"

namespace sweepscope::simulation {
namespace {

/// A walk's figures in section 4.2 of the paper.
struct PaperWalk {
  const char* scene;
  double duration_s, length_m, top_speed_mps, top_angular_rate_radps;
  bool closed;
};

class Walks : public testing::TestWithParam<PaperWalk> {
 protected:
  const Scene scene_ = make_scene(GetParam().scene).value();
  const WalkSpec& spec_ = std::get<WalkSpec>(scene_.motion);
  const Trajectory trajectory_{spec_, 1};
};

TEST_P(Walks, HaveThePapersFiguresWithSwayingIncluded) {
  const PaperWalk& paper = GetParam();
  EXPECT_EQ(spec_.duration_s, paper.duration_s);
  const WalkMeasure walk = measure([&](double t_s) { return trajectory_.at(t_s); }, 0, paper.duration_s);
  EXPECT_NEAR(walk.length_m, paper.length_m, 0.01 * paper.length_m);
  EXPECT_NEAR(walk.top_speed_mps, paper.top_speed_mps, 0.02 * paper.top_speed_mps);
  EXPECT_NEAR(walk.top_angular_rate_radps, paper.top_angular_rate_radps, 0.02 * paper.top_angular_rate_radps);
  EXPECT_NEAR(trajectory_.plan_scale(), 1, 0.02);
}

TEST_P(Walks, EndWhereTheyBeganWhereThePaperSaysSo) {
  const double apart_m =
      (trajectory_.at(0).position_m - trajectory_.at(GetParam().duration_s).position_m).norm();
  if (GetParam().closed)
    EXPECT_LT(apart_m, 0.05);
  else
    EXPECT_GT(apart_m, 20);
}

TEST_P(Walks, BeginAndEndAtRest) {
  const auto speed_mps = [&](double t_s) {
    return (trajectory_.at(t_s + 0.01).position_m - trajectory_.at(t_s).position_m).norm() / 0.01;
  };
  EXPECT_LT(speed_mps(0), 0.01);
  EXPECT_LT(speed_mps(GetParam().duration_s - 0.01), 0.01);
}

TEST_P(Walks, RunIntoNothing) {
  const RayCaster caster(scene_.mesh);
  for (double t_s = 0; t_s < GetParam().duration_s; t_s += 0.5) {
    Vector3d body_m = trajectory_.at(t_s).position_m;
    for (const double z_m : {0.25, 0.9, 1.5, 1.8}) {
      body_m.z() = z_m;
      for (int direction = 0; direction < 12; ++direction) {
        const SinCos turn = sin_cos(radians(30 * direction));
        ASSERT_FALSE(caster.cast(body_m, {turn.cos, turn.sin, 0}, 0.35))
            << t_s << " s, " << body_m.transpose();
      }
    }
  }
}

TEST_P(Walks, DifferWithTheSeedOnlyInTheirSwaying) {
  const Trajectory other(spec_, 2);
  double max_m = 0;
  for (double t_s = 0; t_s < GetParam().duration_s; t_s += 1.3)
    max_m = std::max(max_m, (trajectory_.at(t_s).position_m - other.at(t_s).position_m).norm());
  EXPECT_GT(max_m, 0.005);
  EXPECT_LT(max_m, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Paper, Walks,
                         testing::Values(PaperWalk{"metro-station", 159, 117, 1.3, 0.44, true},
                                         PaperWalk{"parking-area", 208, 155, 1.5, 0.61, true},
                                         PaperWalk{"cemetery", 287, 236, 1.4, 0.74, true},
                                         PaperWalk{"lecture-room", 274, 184, 1.9, 0.91, false}),
                         [](const auto& walk) {
                           std::string name = walk.param.scene;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Scenes, TheMetroStationsPillarIsAHexagonOfAMetreOrSo) {
  const Scene scene = metro_station();
  const RayCaster caster(scene.mesh);
  const auto radius_m = [&](int direction_deg) {
    const SinCos turn = sin_cos(radians(direction_deg));
    const Vector3d inwards(-turn.cos, -turn.sin, 0);
    const auto hit = caster.cast(Vector3d(0, 0, 2.3) - 2.5 * inwards, inwards, 30);
    return hit ? 2.5 - hit->range_m : 0.0;
  };
  const double corner_m = radius_m(0);
  EXPECT_GT(corner_m, 0.4);
  EXPECT_LT(corner_m, 0.8);
  for (int corner_deg = 0; corner_deg < 360; corner_deg += 60) {
    EXPECT_NEAR(radius_m(corner_deg), corner_m, 1e-6);
    EXPECT_NEAR(radius_m(corner_deg + 30), corner_m * 0.8660254037844386, 1e-6);
  }
}

TEST(Scenes, TheMetroStationHasStairsAtBothEnds) {
  const Scene scene = metro_station();
  const RayCaster caster(scene.mesh);
  for (const double end : {-1.0, 1.0}) {
    double before_m = 0;
    for (int step = 0; step < 12; ++step) {
      const auto hit = caster.cast({end * (14.5 + 0.30 * step + 0.15), 0.3, 3.0}, {0, 0, -1}, 30);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(3.0 - hit->range_m - before_m, 0.165, 1e-9);
      before_m = 3.0 - hit->range_m;
    }
  }
}

TEST(Scenes, TheSixRoomsAreOneRoomFromSixPlaces) {
  std::vector<Stand> stands;
  for (int position = 1; position <= 6; ++position) {
    const Scene scene = make_scene("room-" + std::to_string(position)).value();
    EXPECT_EQ(scene.mesh.triangles.size(), room(1).mesh.triangles.size());
    const Stand stand = std::get<Stand>(scene.motion);
    for (const Stand& other : stands) {
      EXPECT_GT((stand.position_m - other.position_m).norm(), 0.5);
      EXPECT_GT(std::abs(stand.yaw_deg - other.yaw_deg), 10);
    }
    stands.push_back(stand);
  }
}

TEST(Scenes, AnUnknownNameIsNone) {
  EXPECT_FALSE(make_scene("room-7"));
}

}  // namespace
}  // namespace sweepscope::simulation
