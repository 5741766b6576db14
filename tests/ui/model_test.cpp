#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <set>
#include <thread>

#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/model/picking.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/model/wall_profile.hpp"

namespace sweepscope::ui {
namespace {

using test::InARoom, test::perform, test::rest, test::scratch;

TEST_F(InARoom, BothMapsAreThereAtOnceSinceTheRigStoodStill) {
  EXPECT_EQ(observe(explorer_, "kind"), "stationary");
  for (const Side side : kBothSides) {
    EXPECT_EQ(explorer_.pane(side).state, PaneState::kSolved);
    EXPECT_GT(explorer_.pane(side).full->points->size(), 20000u);
  }
}

TEST_F(InARoom, AMoveOfTheOffsetIsSeenInTheSameFrameAndAllPointsFollow) {
  const PlacedCloudPtr before = explorer_.pane(Side::kA).coarse;
  perform(explorer_, "offset-a 19");
  explorer_.update(1.0 / 60);
  EXPECT_NE(explorer_.pane(Side::kA).coarse, before);
  EXPECT_EQ(explorer_.pane(Side::kA).full, nullptr);
  rest(explorer_);
  ASSERT_NE(explorer_.pane(Side::kA).full, nullptr);
  EXPECT_NE(explorer_.pane(Side::kA).full->points->xyz_m, explorer_.pane(Side::kB).full->points->xyz_m);
}

TEST_F(InARoom, TheCoarsePointsAreSomeOfAllOfThem) {
  const auto& all = explorer_.pane(Side::kA).full->beams;
  const std::set<std::uint32_t> beams(all.begin(), all.end());
  EXPECT_EQ(beams.size(), all.size());
  for (const std::uint32_t beam : explorer_.pane(Side::kA).coarse->beams) EXPECT_TRUE(beams.contains(beam));
}

TEST_F(InARoom, TheEstimateSetsTheOffsetOfBUnlessAPersonDid) {
  perform(explorer_, "search range");
  perform(explorer_, "search-range 22 26 1");
  perform(explorer_, "estimate");
  rest(explorer_);
  ASSERT_EQ(observe(explorer_, "estimate"), "found");
  EXPECT_NEAR(explorer_.settings().offset_b_ms, 24, 0.51);
  EXPECT_EQ(explorer_.settings().offset_a_ms, 0);
  perform(explorer_, "offset-b 20");
  perform(explorer_, "estimate");
  rest(explorer_);
  EXPECT_EQ(explorer_.settings().offset_b_ms, 20);
  perform(explorer_, "take-found");
  EXPECT_NEAR(explorer_.settings().offset_b_ms, 24, 0.51);
}

TEST_F(InARoom, UndoTakesBackAGestureAsAWhole) {
  for (const char* line : {"offset-a 1", "offset-a 2", "offset-a 3"})
    EXPECT_TRUE(explorer_.perform(line, "drag 1"));
  perform(explorer_, "theme light");
  perform(explorer_, "undo");
  EXPECT_EQ(explorer_.settings().theme, Theme::kDark);
  EXPECT_EQ(explorer_.settings().offset_a_ms, 3);
  perform(explorer_, "undo");
  EXPECT_EQ(explorer_.settings().offset_a_ms, 0);
  perform(explorer_, "redo");
  EXPECT_EQ(explorer_.settings().offset_a_ms, 3);
}

TEST_F(InARoom, LinkedCamerasMoveTogetherAndUnlinkedOnesDoNot) {
  perform(explorer_, "camera-a 1 2 3 4 5 6");
  EXPECT_EQ(explorer_.settings().camera_b, explorer_.settings().camera_a);
  perform(explorer_, "linked off");
  perform(explorer_, "camera-a 9 9 9 9 9 9");
  EXPECT_EQ(explorer_.settings().camera_b.height_m, 4);
  perform(explorer_, "linked on");
  EXPECT_EQ(explorer_.settings().camera_b, explorer_.settings().camera_a);
}

TEST_F(InARoom, ATimeWindowAndASlabShowFewerPoints) {
  const std::size_t all = explorer_.pane(Side::kA).full->points->size();
  perform(explorer_, "time-window 1 2");
  rest(explorer_);
  const std::size_t second = explorer_.pane(Side::kA).full->points->size();
  EXPECT_LT(second, all / 3);
  EXPECT_GT(second, all / 9);
  perform(explorer_, "heights slab");
  perform(explorer_, "slab 0.9 1");
  rest(explorer_);
  EXPECT_LT(explorer_.pane(Side::kA).full->points->size(), second);
  for (const auto& p : explorer_.pane(Side::kA).full->points->xyz_m) EXPECT_NEAR(p[2], 0.95, 0.051);
}

TEST_F(InARoom, TheDifferenceIsNothingBetweenEqualOffsetsAndGrowsWithThem) {
  perform(explorer_, "layout difference");
  rest(explorer_);
  const auto first = explorer_.pane(Side::kB).full->points->rgb[0];
  for (const auto& colour : explorer_.pane(Side::kB).full->points->rgb) EXPECT_EQ(colour, first);
  perform(explorer_, "offset-a 19");
  rest(explorer_);
  const auto& colours = explorer_.pane(Side::kB).full->points->rgb;
  EXPECT_GT(std::set(colours.begin(), colours.end()).size(), 50u);
  EXPECT_GT(explorer_.maps.shown_span().to, 20) << "19 ms at 390 deg/s turn a point at 1 m by 130 mm";
}

TEST_F(InARoom, ColouringByBlurGivesEveryPointAThicknessOrNone) {
  perform(explorer_, "offset-b 24");
  perform(explorer_, "colouring blur");
  rest(explorer_);
  const std::vector<float>& values = *explorer_.pane(Side::kB).slow;
  std::size_t known = 0;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    EXPECT_GE(value, 0);
    ++known;
  }
  // Half of this furnished room's points lie on edges, which have none.
  EXPECT_GT(known, values.size() * 2 / 5);
}

TEST_F(InARoom, APointThatIsAskedNamesItsBeamAndBothItsPlaces) {
  const Pane &a = explorer_.pane(Side::kA), &b = explorer_.pane(Side::kB);
  const PixelRect picture{100, 50, 600, 400};
  const Projection projection = projection_of(explorer_.settings().camera_a, false, picture);
  const auto& p = a.full->points->xyz_m[1234];
  const auto at = projection({p[0], p[1], p[2]});
  ASSERT_TRUE(at);
  const auto found = pick_point(*a.full, projection, *at, 5);
  ASSERT_TRUE(found);
  const auto rows = describe_beam(a.request->placement, b.request->placement, a.full->beams[*found]);
  EXPECT_EQ(rows.back().first, "apart");
  EXPECT_EQ(rows.back().second, "0 mm") << "both offsets are the same";
  EXPECT_FALSE(pick_point(*a.full, projection, {-500, -500}, 5));
}

TEST_F(InARoom, TheStatusLineSaysWhatIsShown) {
  perform(explorer_, "offset-a 19");
  explorer_.update(0.01);
  EXPECT_NE(status(explorer_).find("A: 19.0 ms"), std::string::npos) << status(explorer_);
  rest(explorer_);
  EXPECT_NE(status(explorer_).find("A: 19.0 ms"), std::string::npos) << status(explorer_);
}

TEST_F(InARoom, TheCopiedCommandLineHoldsAllThatDiffersFromTheDefaults) {
  perform(explorer_, "offset-a 19");
  perform(explorer_, "theme light");
  const std::string line = command_line(explorer_, 1200, 800);
  for (const char* part :
       {"sweepscope view", "--size 1200x800", "sample room-1", "offset-a 19", "theme light"})
    EXPECT_NE(line.find(part), std::string::npos) << line;
  EXPECT_EQ(line.find("point-size"), std::string::npos) << line;
}

TEST(OnAWalk, AMapIsPreviewedAndThenSolvedAndTheAnswerIsKept) {
  Explorer explorer;
  perform(explorer, "offset-a 23");
  perform(explorer, "offset-b 23");
  perform(explorer, "sample metro-station 6");
  while (explorer.recording.is_opening()) {
    explorer.update(0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  explorer.update(0.01);
  EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kProvisional);
  rest(explorer);
  EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kSolved);
  explorer.maps.hold(true);
  perform(explorer, "offset-a 24");
  for (int i = 0; i < 30; ++i) explorer.update(0.02);
  EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kPreview);
  EXPECT_EQ(observe(explorer, "jobs"), "0") << "nothing is solved while the handle is held";
  explorer.maps.hold(false);
  rest(explorer);
  EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kSolved);
  perform(explorer, "offset-a 23");
  explorer.update(0.01);
  EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kSolved) << "it was solved before";
}

TEST_F(InARoom, FittingShowsAllThatThereIsFromWhereverItIsLookedAt) {
  const PixelRect pane{0, 0, 300, 450};
  explorer_.set_picture_shape({pane.width / pane.height, 0, 0});
  for (const char* line : {"look top", "look front", "look isometric"}) {
    perform(explorer_, line);
    perform(explorer_, "fit-view");
    const Projection projection = projection_of(explorer_.settings().camera_a, false, pane);
    std::size_t outside = 0;
    const auto& points = explorer_.pane(Side::kA).full->points->xyz_m;
    for (const auto& p : points) {
      const auto at = projection({p[0], p[1], p[2]});
      outside += at->x < 0 || at->y < 0 || at->x > pane.width || at->y > pane.height ? 1 : 0;
    }
    EXPECT_LT(static_cast<double>(outside), 0.05 * static_cast<double>(points.size())) << line;
    EXPECT_LT(explorer_.settings().camera_a.height_m, 30) << line << ": and not much more";
  }
}

TEST_F(InARoom, AnotherRecordingForgetsWhatWasAskedOfTheOneBefore) {
  for (const char* line : {"pick 10 100", "measure 0 0 0 1 1 1", "profile 0 0 1 1"}) perform(explorer_, line);
  perform(explorer_, "sample room-2");
  rest(explorer_);
  EXPECT_EQ(explorer_.settings().asked_scan, -1);
  EXPECT_EQ(explorer_.settings().measure_from_m, explorer_.settings().measure_to_m);
  EXPECT_EQ(explorer_.settings().profile_from_m, explorer_.settings().profile_to_m);
}

// The recording is opened with the rig file that is written, and what was found and chosen stays.
TEST(OverTime, AnEstimateInWindowsHasOneOffsetForEach) {
  Explorer explorer;
  perform(explorer, "sample room-1 32");
  rest(explorer);
  perform(explorer, "search over-time");
  perform(explorer, "estimate");
  rest(explorer);
  EXPECT_EQ(observe(explorer, "estimate"), "found");
  EXPECT_EQ(observe(explorer, "found-windows"), "3");
  EXPECT_NEAR(std::stod(observe(explorer, "found-ms").value()), 24, 0.2);
  perform(explorer, "search-window 15");
  perform(explorer, "estimate");
  rest(explorer);
  EXPECT_EQ(observe(explorer, "found-windows"), "2");
}

TEST(WallProfile, ALineAcrossATownIsDrawnAsFarAsAWallReachesAndWithAChartsWorthOfPoints) {
  Settings settings;
  settings.profile_from_m = {-4000, 10};
  settings.profile_to_m = {4000, 10};
  const auto section = section_of(settings);
  ASSERT_TRUE(section);
  EXPECT_EQ(section->reach_m, 25);
  Profile profile;
  for (int mm = -25000; mm <= 25000; ++mm) {
    profile.distances_mm.push_back(mm);
    profile.density_per_mm.push_back(mm == 7777 ? 0.5 : 1e-5);
  }
  const Chart chart = profile_chart(profile, profile, settings, "", style_of(sweepscope::Background::kDark));
  ASSERT_TRUE(chart.x_range) << "the line, as far as points are taken: 25 m to either side of its middle";
  EXPECT_EQ(chart.x_range->from, 3975000);
  EXPECT_EQ(chart.x_range->to, 4025000);
  EXPECT_LE(chart.series[0].x.size(), 2001U);
  const auto& y = chart.series[0].y;
  const auto peak = std::max_element(y.begin(), y.end());
  EXPECT_EQ(*peak, 0.5);
  EXPECT_EQ(chart.series[0].x[static_cast<std::size_t>(peak - y.begin())], 4007777);
}

TEST(OnAWalk, WhatWasCancelledIsTakenUpWhenItIsAskedForOrTheOffsetMoves) {
  Explorer explorer;
  perform(explorer, "sample metro-station 5");
  while (explorer.recording.is_opening()) {
    explorer.update(0.01);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  explorer.update(0.01);
  ASSERT_EQ(explorer.pane(Side::kA).state, PaneState::kProvisional);
  perform(explorer, "cancel");
  for (int i = 0; i < 5; ++i) explorer.update(0.01);
  EXPECT_NE(explorer.pane(Side::kA).problem.find("Cancelled"), std::string::npos);
  EXPECT_TRUE(explorer.background.keys("solve ").empty());
  perform(explorer, "solve");
  rest(explorer);
  EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kSolved);
  EXPECT_EQ(explorer.pane(Side::kA).problem, "");
}

TEST(OnAWalk, AlongPosesThatAreKnownEveryOffsetIsThereAtOnce) {
  SimulationOptions options;
  options.scene = "metro-station";
  options.duration_s = 4;
  const auto made = simulate(options, Job());
  ASSERT_TRUE(made);
  const std::string bag = scratch("poses.bag").string(), poses = truth_tum_path(bag).string();
  ASSERT_TRUE(write_bag(*made, bag, Job()));
  ASSERT_TRUE(write_truth(*made, bag));
  Explorer explorer;
  perform(explorer, "open " + bag + " " + poses);
  rest(explorer);
  ASSERT_NE(explorer.loaded(), nullptr) << explorer.messages.shown()->text;
  for (const char* line : {"offset-a 19", "offset-a 24"}) {
    perform(explorer, line);
    explorer.update(0.01);
    EXPECT_EQ(explorer.pane(Side::kA).state, PaneState::kSolved) << line;
  }
  EXPECT_EQ(explorer.loaded()->source, "open " + bag + " " + poses);
  std::filesystem::remove(bag);
  std::filesystem::remove(poses);
  std::filesystem::remove(truth_json_path(bag));
}

}  // namespace
}  // namespace sweepscope::ui
