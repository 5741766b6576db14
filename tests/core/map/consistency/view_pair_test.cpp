#include "core/map/consistency/view_pair.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {

// Of views whose surfaces determine the move between them.
ViewPair pair_of(SurfaceFit placed, SurfaceFit moved, std::size_t gained, std::size_t given_up,
                 double apart_m) {
  ViewPair pair;
  pair.features = 250;
  pair.placed = placed;
  pair.moved = moved;
  pair.gained = gained;
  pair.given_up = given_up;
  pair.apart_m = apart_m;
  pair.translation_sigma_m = 0.01;
  pair.rotation_sigma_rad = 0.002;
  return pair;
}

TEST(ViewPair, AMoveThatFitsClearlyBetterThanNoneTellsHowFarSurfacesLieApart) {
  EXPECT_TRUE(pair_of({81, 59}, {130, 117}, 74, 16, 0.99).coincides());
}

// Two views of tunnel:1005 along a true trajectory: its walls look alike half a metre on.
TEST(ViewPair, AMoveThatTakesAwayAsManyFeaturesAsItBringsTellsNothing) {
  EXPECT_FALSE(pair_of({166, 147}, {172, 144}, 18, 21, 0.54).coincides());
}

// Two views of tunnel:1021: what matches as placed lies on its surfaces, and the move finds others.
TEST(ViewPair, AMoveOfFeaturesThatFittedWhereTheyWereTellsNothing) {
  EXPECT_FALSE(pair_of({81, 75}, {123, 109}, 42, 8, 1.72).coincides());
}

TEST(ViewPair, ASmallMoveNeedsNoGain) {
  EXPECT_TRUE(pair_of({173, 153}, {172, 153}, 0, 0, 0.01).coincides());
}

// Two views of tunnel:7005, of which few features see the same surfaces.
TEST(ViewPair, ViewsThatShareFewSurfacesTellNothing) {
  EXPECT_FALSE(pair_of({50, 41}, {103, 91}, 55, 5, 1.64).coincides());
}

TEST(ViewPair, AMoveThatIsNotDeterminedInEveryDirectionTellsNothing) {
  ViewPair pair = pair_of({81, 59}, {130, 117}, 74, 16, 0.99);
  pair.translation_sigma_m = 0.1;
  EXPECT_FALSE(pair.determined());
  EXPECT_FALSE(pair.coincides());
}

}  // namespace
}  // namespace sweepscope
