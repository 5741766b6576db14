#include "core/offset/stationary/stationary_points.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

constexpr double kBoxTruth_s = 0.017;

// A bare box about a rig that stands in it, and no noise.
class InABox : public testing::Test {
 protected:
  static const Recording& recording() {
    static const Recording recording = [] {
      test::Bench bench;
      bench.mesh = simulation::box(kLow_m, kHigh_m);
      bench.duration_s = 2.5;
      bench.offset_s = kBoxTruth_s;
      return bench.record();
    }();
    return recording;
  }
  static double from_wall_m(const Eigen::Vector3d& p_m) {
    return std::min((p_m - kLow_m).cwiseAbs().minCoeff(), (kHigh_m - p_m).cwiseAbs().minCoeff());
  }
  static inline const Eigen::Vector3d kLow_m{-5, -3, -1.5}, kHigh_m{4, 2, 1.3};

  const OffsetProblem problem_ = test::problem_of(recording());
  const StationaryGrid grid_ = stationary_grid(problem_);
};

TEST_F(InABox, AtTheTrueOffsetPointsLieOnItsWalls) {
  const StationaryPoints points = place_stationary(grid_, kBoxTruth_s, StationaryDetail::kPoints);
  std::size_t placed = 0;
  for (std::size_t cell = 0; cell < points.placed.size(); ++cell) {
    if (!points.placed[cell]) continue;
    ++placed;
    EXPECT_LT(from_wall_m(points.p_m[cell]), 0.002) << cell;
  }
  EXPECT_GT(placed, 3000U);
}

TEST_F(InABox, EveryCellHasTheMotorsAngleAndSpeedOneOffsetAfterItsStamp) {
  constexpr double kPlaced_s = -0.011;
  const StationaryPoints points = place_stationary(grid_, kPlaced_s, StationaryDetail::kPoints);
  const double speed_rad_s = test::kPi / test::Bench().sweep_s;
  std::size_t placed = 0;
  for (std::size_t cell = 0; cell < points.placed.size(); ++cell) {
    if (!points.placed[cell]) continue;
    ++placed;
    const std::size_t line = cell / points.bins;
    EXPECT_NEAR(points.angle_rad[cell], recording().motor.angle_at(grid_.time_s[cell] + kPlaced_s), 1e-9);
    EXPECT_GT(points.speed_rad_s[cell] * float(points.direction[line]), 0.5 * speed_rad_s);
    EXPECT_LT(points.speed_rad_s[cell] * float(points.direction[line]), 1.1 * speed_rad_s);
  }
  EXPECT_GT(placed, 3000U);
}

TEST_F(InABox, LinesOfADirectionLieInTheOrderOfTheirAngle) {
  const StationaryPoints points = place_stationary(grid_, kBoxTruth_s, StationaryDetail::kAngles);
  EXPECT_TRUE(points.p_m.empty());
  for (const int turning : {-1, 1}) {
    const LinePool& pool = points.against(-turning);
    ASSERT_GT(pool.size(), 30U);
    for (std::size_t i = 0; i < pool.size(); ++i) {
      EXPECT_EQ(points.direction[pool[i]], turning);
      if (i == 0) continue;
      const std::size_t middle = points.bins / 2;
      EXPECT_LE(points.angle_rad[pool[i - 1] * points.bins + middle],
                points.angle_rad[pool[i] * points.bins + middle]);
    }
  }
  std::size_t lines = 0;
  for (const LinePool& pool : pools_by_sweep(points)) lines += pool.size();
  EXPECT_EQ(lines, points.pool[0].size() + points.pool[1].size());
}

TEST_F(InABox, PatchesOfTheOtherDirectionLieOnTheWallOfTheirPoint) {
  const StationaryPatchOptions options = stationary_patch_options(problem_);
  const StationaryPoints points = place_stationary(grid_, kBoxTruth_s, StationaryDetail::kPoints);
  std::size_t found = 0, flat = 0;
  for (std::size_t line = 0; line < points.lines(); ++line) {
    StationaryNeighbours neighbours(points, points.against(points.direction[line]), line, options);
    for (std::size_t bin = 0; bin < points.bins; ++bin) {
      const std::size_t cell = line * points.bins + bin;
      if (!points.placed[cell]) continue;
      const StationaryPatch patch = neighbours.patch(points.angle_rad[cell], bin, grid_.range_m[cell]);
      if (!patch.found) continue;
      ++found;
      EXPECT_LT(patch.speed_rad_s * points.speed_rad_s[cell], 0) << "the other direction turns against it";
      // But for patches over an edge of the box.
      flat += patch.normal.cwiseAbs().maxCoeff() > 0.9999 &&
              std::abs(patch.normal.dot(points.p_m[cell] - patch.centre_m)) < 0.002;
    }
  }
  EXPECT_GT(found, 2000U);
  EXPECT_GT(double(flat), 0.9 * double(found));
}

TEST_F(InABox, ABracketHoldsTheAngleAndBeyondTheLinesThereIsNone) {
  const StationaryPatchOptions options = stationary_patch_options(problem_);
  const StationaryPoints points = place_stationary(grid_, kBoxTruth_s, StationaryDetail::kPoints);
  const LinePool& pool = points.pool[1];
  StationaryNeighbours neighbours(points, pool, pool[0], options);
  std::size_t found = 0;
  for (std::size_t bin = 0; bin < points.bins; ++bin) {
    EXPECT_FALSE(neighbours.bracket(3, bin).found);
    EXPECT_FALSE(neighbours.bracket(-3, bin).found);
    EXPECT_FALSE(neighbours.patch(3, bin, 5).found);
    const auto pair = neighbours.bracket(0.1, bin);
    if (!pair.found) continue;  // no plane point there, or one on the motor's axis
    ++found;
    EXPECT_LT(points.angle_rad[pair.below], 0.1);
    EXPECT_GE(points.angle_rad[pair.above], 0.1);
    EXPECT_LE(points.angle_rad[pair.above] - points.angle_rad[pair.below], options.reach_rad);
  }
  EXPECT_GT(found, points.bins / 4);
}

}  // namespace
}  // namespace sweepscope
