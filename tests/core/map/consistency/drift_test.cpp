#include "core/map/consistency/drift.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// Ten views of 2 s, of a rig that moves at 1 m/s along -x.
std::vector<WalkView> ten_views() {
  std::vector<WalkView> views(10);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].begin_s = 2.0 * double(i);
    views[i].end_s = 2.0 * double(i + 1);
    views[i].at.translation_m = {-2.0 * double(i), 0, 0};
  }
  return views;
}

// So many matches face x in the moves to the views [first, end), and twenty z in the others.
std::vector<FacedMove> moves_but(std::size_t first, std::size_t end, double facing) {
  std::vector<FacedMove> moves;
  for (std::size_t i = 1; i < 10; ++i) moves.push_back({i - 1, i, {Vector3d::UnitZ(), 20}});
  for (std::size_t i = first; i < end; ++i) moves[i - 1].weakest = {Vector3d::UnitX(), facing};
  return moves;
}

TEST(Drift, IsBetweenTheViewsWhoseMoveNoMatchFaces) {
  const auto times = drifting_times(ten_views(), moves_but(4, 7, 0.3));
  ASSERT_EQ(times.size(), 1u);
  EXPECT_DOUBLE_EQ(times[0].at_s.begin_s, 7);
  EXPECT_DOUBLE_EQ(times[0].at_s.end_s, 13);
  EXPECT_DOUBLE_EQ(times[0].place_m.x(), -10);
  EXPECT_EQ(times[0].direction, -Vector3d::UnitX()) << "as the rig moved";
  // 0.25 m/s in a second, known at both ends: 0.25 * sqrt(6^3 / 12).
  EXPECT_NEAR(times[0].drift_m, 1.061, 1e-3);
  EXPECT_NEAR(times[0].rmse_m, 0.530, 1e-3) << "half of the walk before it, half after";
}

TEST(Drift, IsFartherAtAnEndOfTheRecordingButMovesNothingElse) {
  const auto times = drifting_times(ten_views(), moves_but(7, 10, 0.3));
  ASSERT_EQ(times.size(), 1u);
  EXPECT_DOUBLE_EQ(times[0].at_s.begin_s, 13);
  EXPECT_DOUBLE_EQ(times[0].at_s.end_s, 20);
  EXPECT_NEAR(times[0].drift_m, 2.673, 1e-3);  // 0.25 * sqrt(7^3 / 3)
  EXPECT_NEAR(times[0].rmse_m, 0.791, 1e-3) << "half of that, over 7 of 20 s";
}

TEST(Drift, IsNoneWhereMatchesFaceTheWeakestDirection) {
  EXPECT_TRUE(drifting_times(ten_views(), moves_but(4, 7, 0.7)).empty());
}

TEST(Drift, IsNoneOfAMoveBetweenTwoMaps) {
  std::vector<FacedMove> moves = moves_but(4, 5, 0.3);
  moves.erase(moves.begin() + 3);
  EXPECT_TRUE(drifting_times(ten_views(), moves).empty());
}

TEST(Drift, IsNoneWhereOnlyAPlaceSeenAgainHasNoMatches) {
  std::vector<FacedMove> moves = moves_but(0, 0, 0);
  moves.push_back({1, 7, {Vector3d::UnitX(), 0}});
  moves.push_back({2, 4, {Vector3d::UnitX(), 0}});
  EXPECT_TRUE(drifting_times(ten_views(), moves).empty());
}

TEST(Drift, IsNoneWhereAViewBeyondShowsTheMove) {
  for (const std::size_t from : {2, 3}) {
    std::vector<FacedMove> moves = moves_but(4, 5, 0.3);
    moves.push_back({from, from + 2, {Vector3d::UnitX(), 0.5}});
    EXPECT_EQ(drifting_times(ten_views(), moves).size(), 1u);
    moves.back().weakest.facing = 5;
    EXPECT_TRUE(drifting_times(ten_views(), moves).empty());
  }
}

TEST(Drift, IsWarnedOfBeyondItsLimitWithItsTimeItsPlaceAndItsDirection) {
  const auto times = drifting_times(ten_views(), moves_but(4, 7, 0.3));
  EXPECT_FALSE(drift_warning(times, 0.55));
  EXPECT_EQ(drift_warning(times, 0.5),
            "From 7 to 13 s, near (-10.0, 0.0, 0.0) m, nothing in view shows how far the rig moved along "
            "(-1.00, 0.00, 0.00). The map may be wrong there by 1.1 m in this direction.");
  EXPECT_FALSE(drift_warning({}, 0));
}

}  // namespace
}  // namespace sweepscope
