#include "core/loam/path/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;

// A walk at 1 m/s. Between two times it is creeping, in the eyes of a track that errs.
Pose strolled_to(double t_s, double creeps_from_s, double creeps_to_s) {
  constexpr double kCreep_mps = 0.1;
  const double crept_s = std::clamp(t_s, creeps_from_s, creeps_to_s) - creeps_from_s;
  return {rotation_from_vector({0.03 * std::sin(2 * t_s), 0, 0.2 * t_s}),
          Vector3d(t_s - (1 - kCreep_mps) * crept_s, 0.02 * std::cos(6 * t_s), 0)};
}

std::vector<SweepPose> stroll(double creeps_from_s = 0, double creeps_to_s = 0) {
  std::vector<SweepPose> sweeps(40);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    SweepPose& sweep = sweeps[k];
    sweep.sweep = k;
    sweep.direction = k % 2 == 0 ? 1 : -1;
    sweep.begin_s = 0.5 * double(k);
    sweep.end_s = sweep.begin_s + 0.5;
    sweep.knots.clear();
    for (int i = 0; i <= 10; ++i)
      sweep.knots.push_back(strolled_to(sweep.begin_s + i / 20.0, creeps_from_s, creeps_to_s));
  }
  return sweeps;
}

std::size_t agreed(const std::vector<SweepPose>& a, const std::vector<SweepPose>& b) {
  return std::size_t(std::ranges::count(agreeing(a, b), 1));
}

TEST(Agreeing, TracksOnMapsOfTheirOwnAgreeWhereverTheirMapsLie) {
  std::vector<SweepPose> moved = stroll();
  const Pose there{rotation_from_vector({0, 0, 2}), Vector3d(5, -3, 1)};
  for (SweepPose& sweep : moved)
    for (Pose& knot : sweep.knots) knot = there * knot;
  EXPECT_EQ(agreed(stroll(), moved), 40u);
}

TEST(Agreeing, WhereOneTrackCreepsTheyDisagree) {
  const std::vector<char> found = agreeing(stroll(), stroll(8, 12));
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k] == 0, k >= 16 && k < 24) << k;
}

TEST(Agreeing, ASweepThatEitherLostIsNotConfirmed) {
  std::vector<SweepPose> lost = stroll();
  lost[20].lost = true;
  EXPECT_EQ(agreed(stroll(), lost), 39u);
  EXPECT_EQ(agreed(lost, stroll()), 39u);
}

TEST(Agreeing, AMapThatIsBentWithTheMotorAgreesWithAStraightOne) {
  std::vector<SweepPose> bent = stroll();
  Vector6d bend;
  bend << 0.03, 0, 0, 0, 0.05, 0;
  for (SweepPose& sweep : bent)
    for (std::size_t i = 0; i < sweep.knots.size(); ++i) {
      const double angle = sweep.direction * (2.0 * double(i) / double(sweep.knots.size() - 1) - 1);
      const Pose deviation = stepped(Pose{}, angle * bend, Vector3d::Zero());
      sweep.knots[i] = sweep.knots[i] * deviation;
    }
  EXPECT_EQ(agreed(stroll(), bent), 40u);
}

TEST(Agreeing, OfLessThanTwoSecondsNothingIsConfirmed) {
  std::vector<SweepPose> few = stroll();
  few.resize(3);
  EXPECT_EQ(agreed(few, few), 0u);
}

double way_m(const std::vector<SweepPose>& poses) {
  return (poses.back().end().translation_m - poses.front().begin().translation_m).norm();
}

MendedTrack mended_stroll(const std::vector<SweepPose>& own, const std::vector<JudgedTrack>& others) {
  std::vector<char> agreed(own.size(), 0);
  for (const JudgedTrack& other : others) {
    const std::vector<char> found = agreeing(own, other.poses);
    for (std::size_t k = 0; k < agreed.size(); ++k) agreed[k] |= found[k];
  }
  return mended(own, agreed, others);
}

TEST(Mended, WhereATrackIsAloneItsMotionIsThatOfTwoOthers) {
  const std::vector<SweepPose> other = stroll();
  const std::vector<char> agreed(other.size(), 1);
  const MendedTrack track = mended_stroll(stroll(8, 12), {{other, agreed}});
  EXPECT_GT(way_m(other) - way_m(stroll(8, 12)), 1);
  EXPECT_NEAR(way_m(track.poses), way_m(other), 0.01);
  EXPECT_EQ(std::ranges::count(track.agreed, 1), 40);
  EXPECT_TRUE(track.contradictions.empty());
}

TEST(Mended, OfTwoTracksNeitherIsTakenForRight) {
  const std::vector<SweepPose> own = stroll(8, 12), other = stroll();
  const MendedTrack track = mended_stroll(own, {{other, agreeing(own, other)}});
  EXPECT_EQ(way_m(track.poses), way_m(own));
  ASSERT_EQ(track.contradictions.size(), 1u);
  EXPECT_EQ(track.contradictions[0].begin_s, 8);
  EXPECT_EQ(track.contradictions[0].end_s, 12);
  EXPECT_NEAR(track.contradictions[0].apart.shift_m, 3.6, 0.2);
}

TEST(Contradiction, SaysHowFarTheTracksAreApartAndTurned) {
  EXPECT_NE(in_words({14, 16, {0.3, 1.5}}, 10).find("From 4 to 6 s"), std::string::npos);
  EXPECT_NE(in_words({14, 16, {0.3, 1.5}}, 10).find("it ends 0.3 m and 86 deg apart"), std::string::npos);
  EXPECT_NE(in_words({14, 16, {3, 0.01}}, 10).find("it ends 3.0 m apart"), std::string::npos);
}

TEST(Mended, AConfirmedTrackOfAnotherOffsetIsTakenAndRemainsAContradiction) {
  const std::vector<SweepPose> other = stroll();
  const std::vector<char> agreed(other.size(), 1);
  const MendedTrack track = mended_stroll(stroll(8, 12), {{other, agreed, true}});
  EXPECT_NEAR(way_m(track.poses), way_m(other), 0.01);
  EXPECT_EQ(track.contradictions.size(), 1u);
}

// It ends where the others do, and all that follows is turned about that place.
TEST(Mended, ASuddenTurnThatNoOtherTrackHasIsTakenBack) {
  constexpr std::size_t kFirst = 16, kEnd = 20;
  const std::vector<SweepPose> other = stroll();
  const std::vector<char> agreed(other.size(), 1);
  std::vector<SweepPose> own = other;
  const Vector3d about_m = own[kEnd].begin().translation_m;
  for (std::size_t k = kFirst; k < own.size(); ++k)
    for (std::size_t i = 0; i < own[k].knots.size(); ++i) {
      const double part = std::min(1.0, (double(k - kFirst) + double(i) / 10) / double(kEnd - kFirst));
      const Eigen::Quaterniond turn = rotation_from_vector({0, 0, 1.5 * part});
      Pose& knot = own[k].knots[i];
      knot = {turn * knot.rotation, about_m + (k < kEnd ? knot.translation_m - about_m
                                                        : Vector3d(turn * (knot.translation_m - about_m)))};
    }
  EXPECT_GT((own.back().end().translation_m - other.back().end().translation_m).norm(), 5);
  const MendedTrack track = mended_stroll(own, {{other, agreed}});
  EXPECT_LT((track.poses.back().end().translation_m - other.back().end().translation_m).norm(), 0.05);
  EXPECT_TRUE(track.contradictions.empty());
}

TEST(Mended, TracksThatDifferByLessThanAMetreStayAsTheyAre) {
  const std::vector<SweepPose> own = stroll(8, 8.8), other = stroll();
  const std::vector<char> agreed(other.size(), 1);
  const MendedTrack track = mended_stroll(own, {{other, agreed}});
  EXPECT_LT(std::ranges::count(track.agreed, 1), 40);
  EXPECT_EQ(way_m(track.poses), way_m(own));
  EXPECT_TRUE(track.contradictions.empty());
}

TEST(Mended, WhereAllOthersAreLostNothingIsKnown) {
  std::vector<SweepPose> other = stroll();
  for (std::size_t k = 15; k < 26; ++k) other[k].lost = true;
  const std::vector<char> agreed(other.size(), 1);
  const MendedTrack track = mended_stroll(stroll(8, 12), {{other, agreed}});
  EXPECT_EQ(way_m(track.poses), way_m(stroll(8, 12)));
  EXPECT_TRUE(track.contradictions.empty());
}

}  // namespace
}  // namespace sweepscope
