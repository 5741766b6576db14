#include "core/map/sections/cross_section.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "core/numbers.hpp"
#include "tests/core/map/noisy_surfaces.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using test::kWidthPerDeviation;
using test::NoisySurfaces;

// A wall through (3, 2), 2 m long and 2 m high, its normal 30 deg from x, seen by sweeps of both directions.
struct Wall {
  double noise_m = 0.010, shift_m = 0, lean_rad = 0;
  int points = 20000;

  CrossSection section() const {
    CrossSection section;
    section.at_m = {3, 2};
    section.normal_rad = 30 * kRadPerDeg;
    section.lean_rad = lean_rad;
    section.length_m = 1.6;
    section.from_m = 1;
    section.to_m = 3;
    return section;
  }
  MapCloud map() const {
    const CrossSection s = section();
    NoisySurfaces map;
    map.patch(points, {3, 2, 2}, s.along(), s.across().cross(s.along()), noise_m, shift_m);
    return map.cloud;
  }
};

TEST(CrossSection, TheWidthAtHalfHeightOfASharpWallIsThatOfItsNoise) {
  for (const double noise_m : {0.005, 0.010, 0.020}) {
    const Wall wall{noise_m};
    const Profile profile = profile_across(wall.map(), wall.section());
    EXPECT_NEAR(*profile.width_at_half_height_mm, kWidthPerDeviation * noise_m * 1e3, 60 * noise_m + 0.4);
    EXPECT_NEAR(profile.median_mm, 0, 0.5);
  }
}

TEST(CrossSection, TheWidthSpansBothLayersOfADoubledWall) {
  const Wall wall{0.010, 0.025};
  const Profile profile = profile_across(wall.map(), wall.section());
  EXPECT_NEAR(*profile.width_at_half_height_mm, 50 + 23.5, 3);
  EXPECT_GT(*profile.integral_width_mm, 1.7 * 26);
}

TEST(CrossSection, ALayerBelowHalfThePeakShowsInTheIntegralWidthAlone) {
  const Wall wall{0.010, 0.06};
  MapCloud map = wall.map(), lopsided;
  // Of one layer only every third point.
  for (std::size_t i = 0; i < map.size(); ++i)
    if (map[i].sweep == 0 || i % 6 == 1) lopsided.push_back(map[i]);
  const Profile profile = profile_across(lopsided, wall.section());
  EXPECT_NEAR(*profile.width_at_half_height_mm, 23.5, 1.5);
  EXPECT_GT(*profile.integral_width_mm, 1.25 * 26);
}

TEST(CrossSection, TheDensityIsNormalisedAndAboutTheMedian) {
  const Wall wall;
  CrossSection beside = wall.section();
  beside.at_m += 0.04 * Eigen::Vector2d(std::cos(30 * kRadPerDeg), std::sin(30 * kRadPerDeg));
  const Profile profile = profile_across(wall.map(), beside);
  double sum = 0, first = 0;
  for (std::size_t i = 0; i < profile.density_per_mm.size(); ++i) {
    sum += profile.density_per_mm[i];
    first += profile.density_per_mm[i] * profile.distances_mm[i];
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  EXPECT_NEAR(first, 0, 0.5);
  EXPECT_NEAR(profile.median_mm, -40, 0.5);
  EXPECT_NEAR(*profile.width_at_half_height_mm, 23.5, 1.2);
}

TEST(CrossSection, OnlyPointsInsideCount) {
  const Wall wall;
  CrossSection half = wall.section();
  half.to_m = 2;
  const std::size_t whole = profile_across(wall.map(), wall.section()).points;
  EXPECT_NEAR(double(whole), 16000, 300);
  EXPECT_NEAR(double(profile_across(wall.map(), half).points), double(whole) / 2, 300);
}

TEST(CrossSection, TooFewPointsHaveNoWidth) {
  Wall wall;
  wall.points = 200;
  EXPECT_FALSE(profile_across(wall.map(), wall.section()).width_at_half_height_mm);
  EXPECT_FALSE(face_fitted(wall.map(), wall.section()));
  const Profile nothing = profile_across(MapCloud(), wall.section());
  EXPECT_EQ(nothing.points, 0u);
  EXPECT_TRUE(nothing.density_per_mm.empty());
}

TEST(CrossSection, ARoughlyNamedFaceIsFound) {
  Wall wall;
  wall.lean_rad = 1.5 * kRadPerDeg;
  const MapCloud map = wall.map();
  CrossSection rough = wall.section();
  rough.at_m += Eigen::Vector2d(0.06, 0.03);
  rough.normal_rad += 4 * kRadPerDeg;
  rough.lean_rad = 0;
  EXPECT_GT(*profile_across(map, rough).width_at_half_height_mm, 40);
  const auto fitted = face_fitted(map, rough);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->normal_rad, 30 * kRadPerDeg, 0.1 * kRadPerDeg);
  EXPECT_NEAR(fitted->lean_rad, 1.5 * kRadPerDeg, 0.1 * kRadPerDeg);
  EXPECT_NEAR(wall.section().across().dot(fitted->middle_m() - wall.section().middle_m()), 0, 0.001);
  EXPECT_NEAR(*profile_across(map, *fitted).width_at_half_height_mm, 23.5, 1.2);
}

TEST(CrossSection, ClutterBesideTheFaceDoesNotPullTheFit) {
  const Wall wall;
  MapCloud map = wall.map();
  const CrossSection s = wall.section();
  NoisySurfaces clutter;
  clutter.patch(4000, s.middle_m() + 0.15 * s.across() + 0.5 * s.along(), 0.3 * s.along(), {0, 0, 1}, 0.01);
  map += clutter.cloud;
  const auto fitted = face_fitted(map, s);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->normal_rad, s.normal_rad, 0.2 * kRadPerDeg);
}

// A corridor along x: walls at y = -2 and 2, a wall across at x = 8, and a rig that walks 6 m along it at
// height 0. Sweeps of either direction are rolled about the rig's axis by an error.
class Corridor {
 public:
  explicit Corridor(double roll_error_rad) {
    for (int i = 0; i <= 60; ++i) {
      StampedPose& pose = path.emplace_back();
      pose.time_s = 0.5 * i;
      pose.position_m = {0.1 * i, 0, 0};
    }
    simulation::Random random(3, 9, 0);
    for (int i = 0; i < 300000; ++i) {
      const double time_s = 30.0 * i / 300000, u = random.uniform();
      const auto sweep = static_cast<std::uint32_t>(time_s / 0.5);
      const Vector3d rig_m(0.2 * time_s, 0, 0);
      Vector3d p_m(8, 4 * random.uniform() - 2, 0);
      if (u < 0.8) p_m = {8 * random.uniform(), u < 0.4 ? -2.0 : 2.0, 0};
      p_m.z() = 4.5 * random.uniform() - 1.5;
      p_m += 0.006 * Vector3d(random.normal(), random.normal(), random.normal());
      const double roll_rad = sweep % 2 == 0 ? roll_error_rad : -roll_error_rad;
      p_m = rig_m + Eigen::AngleAxisd(roll_rad, Vector3d::UnitX()) * (p_m - rig_m);
      map_.add(p_m, sweep);
      map_.cloud.back().time_s = time_s;
    }
  }
  MapOnPath on_path() const { return {&map_.cloud, path}; }

  std::vector<StampedPose> path;

 private:
  NoisySurfaces map_;
};

void expect_side_wall(const CrossSection& section) {
  EXPECT_NEAR(std::abs(section.at_m.y()), 2, 0.02);
  EXPECT_NEAR(std::abs(std::sin(section.normal_rad)), 1, 0.01);
  EXPECT_TRUE(section.from_m > 0.75 || section.to_m < -0.75);
}

TEST(BestSection, IsASideWallHighAboveTheRigWhoseWidthGrows) {
  const Corridor sharp(0.001), blurred(0.03);
  const std::vector<MapOnPath> maps = {blurred.on_path(), sharp.on_path()};
  const auto best = best_section(maps);
  ASSERT_TRUE(best);
  expect_side_wall(best->section);
  EXPECT_EQ(best->sharpest, 1u);
  ASSERT_EQ(best->widths_mm.size(), 2u);
  EXPECT_NEAR(best->widths_mm[1], kWidthPerDeviation * 6, 4);
  EXPECT_GT(best->widths_mm[0], 2 * best->widths_mm[1]);
  EXPECT_GT(best->lever_m, 0.8);
}

TEST(BestSection, OfOneMapItIsTheFaceThatAWrongOffsetWouldBlur) {
  const Corridor sharp(0), blurred(0.0314);
  const MapOnPath map = sharp.on_path();
  const auto best = best_section({&map, 1});
  ASSERT_TRUE(best);
  expect_side_wall(best->section);
  const MapOnPath other = blurred.on_path();
  EXPECT_GT(*profile_across(*other.cloud, best->section).width_at_half_height_mm, 2 * best->widths_mm[0]);
}

TEST(BestSection, LooksOnlyNearAPlaceThatIsNamed) {
  const Corridor sharp(0.001), blurred(0.03);
  const std::vector<MapOnPath> maps = {sharp.on_path(), blurred.on_path()};
  SectionSearch search;
  search.near_m = Eigen::Vector2d(2, -2);
  search.near_radius_m = 0.8;
  const auto best = best_section(maps, search);
  ASSERT_TRUE(best);
  EXPECT_LT((best->section.at_m - *search.near_m).norm(), 0.9);
  search.near_m = Eigen::Vector2d(2, 20);
  EXPECT_FALSE(best_section(maps, search));
}

TEST(BestSection, IsTheSameForAnyNumberOfThreads) {
  const Corridor sharp(0.001), blurred(0.03);
  const std::vector<MapOnPath> maps = {sharp.on_path(), blurred.on_path()};
  const auto many = best_section(maps);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = best_section(maps);
  ASSERT_TRUE(many && single);
  EXPECT_EQ(many->section.at_m, single->section.at_m);
  EXPECT_EQ(many->section.normal_rad, single->section.normal_rad);
  EXPECT_EQ(many->widths_mm, single->widths_mm);
}

// A face of 0.5 m: a column has points along its whole width, but no plane.
TEST(BestSection, IsNotARoundColumn) {
  const auto found_on = [](double radius_m) {
    NoisySurfaces map;
    std::vector<StampedPose> path(2);
    path[1].time_s = 30;
    simulation::Random random(4, 9, 0);
    for (int i = 0; i < 200000; ++i) {
      const auto sweep = static_cast<std::uint32_t>(60.0 * i / 200000);
      const double along_m = random.uniform() - 0.5;
      const double bend_m = radius_m - std::sqrt(radius_m * radius_m - along_m * along_m);
      Vector3d p_m(along_m, 2 + bend_m, 1 + 2 * random.uniform());
      map.add(p_m + 0.006 * Vector3d(random.normal(), random.normal(), random.normal()), sweep);
      map.cloud.back().time_s = 30.0 * i / 200000;
    }
    const MapOnPath on_path{&map.cloud, path};
    return best_section({&on_path, 1}).has_value();
  };
  EXPECT_TRUE(found_on(1000));
  EXPECT_FALSE(found_on(0.8));
}

TEST(BestSection, NothingInSightIsNothing) {
  EXPECT_FALSE(best_section({}));
  const MapCloud empty;
  const MapOnPath map{&empty, {}};
  EXPECT_FALSE(best_section({&map, 1}));
}

}  // namespace
}  // namespace sweepscope
