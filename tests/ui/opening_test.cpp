// What opening a recording begins, and what stays of the one before.
#include <gtest/gtest.h>

#include "core/io/atomic_file.hpp"
#include "core/loam/path/agreement.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/explorer/observables.hpp"

namespace sweepscope::ui {
namespace {

using test::perform, test::rest, test::scratch;

Explorer::Options estimating() {
  Explorer::Options options;
  options.estimates_on_opening = true;
  return options;
}

/// Frames until the recording that was asked for is there.
void load(Explorer& explorer, const std::string& line) {
  perform(explorer, line);
  do {
    explorer.update(1.0 / 60);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  } while (explorer.recording.is_opening());
  explorer.update(1.0 / 60);
}

TEST(Opening, EstimatesAndShowsTheBlurAndItsCure) {
  Explorer explorer(estimating());
  load(explorer, "sample room-1");
  EXPECT_TRUE(explorer.is_answering());
  rest(explorer);
  explorer.update(1.0 / 60);
  EXPECT_FALSE(explorer.is_answering());
  EXPECT_EQ(observe(explorer, "estimate"), "found");
  EXPECT_EQ(explorer.settings().offset_a_ms, 0);
  EXPECT_NEAR(explorer.settings().offset_b_ms, 24, 0.1);
  EXPECT_EQ(fmt::format("{}", explorer.settings().offset_b_ms),
            fmt::format("{:.4g}", *explorer.estimating.found()->offset_s * 1e3))
      << "map B has the offset that the headline shows";
  EXPECT_EQ(explorer.settings().colouring, ColourBy::kBlur);
  EXPECT_NE(explorer.place(), nullptr);
  const Pane &a = explorer.pane(Side::kA), &b = explorer.pane(Side::kB);
  ASSERT_TRUE(a.thickness && b.thickness);
  EXPECT_EQ(observe(explorer, "walls"),
            fmt::format("Walls are {:.0f} mm thick as recorded, {:.0f} mm at {:.2f} ms.",
                        a.thickness->median_m * 1e3, b.thickness->median_m * 1e3,
                        *explorer.estimating.found()->offset_s * 1e3));
  EXPECT_GT(a.thickness->median_m, 2 * b.thickness->median_m);
  perform(explorer, "undo");
  EXPECT_EQ(explorer.settings().colouring, ColourBy::kElevation);
}

TEST(Opening, WhatIsOpenedAgainIsNotEstimatedAgain) {
  Explorer explorer(estimating());
  perform(explorer, "sample room-1");
  rest(explorer);
  const double found_s = *explorer.estimating.found()->offset_s;
  perform(explorer, "close");
  EXPECT_EQ(explorer.settings().offset_b_ms, 0);
  load(explorer, "sample room-1");
  EXPECT_FALSE(explorer.estimating.is_running());
  ASSERT_NE(explorer.estimating.found(), nullptr);
  EXPECT_EQ(explorer.estimating.found()->offset_s, found_s);
  EXPECT_EQ(explorer.settings().offset_b_ms, explorer.found_offset_ms());
  rest(explorer);
  EXPECT_NE(explorer.walls_in_words(), "");
}

TEST(Opening, ASessionThatHoldsTheAnswerIsNotEstimated) {
  const std::string path = scratch("answered.json").string();
  {
    Explorer explorer(estimating());
    perform(explorer, "sample room-1");
    rest(explorer);
    perform(explorer, "save-session " + path);
  }
  Explorer explorer(estimating());
  load(explorer, "open " + path);
  EXPECT_FALSE(explorer.estimating.is_running());
  EXPECT_NE(explorer.estimating.found(), nullptr);
  std::filesystem::remove(path);
}

TEST(Opening, DoesNotEstimateWhereTheSettingOrTheProgramForbidsIt) {
  Explorer by_setting(estimating());
  perform(by_setting, "estimate-on-opening off");
  load(by_setting, "sample room-1 2");
  Explorer by_option;
  load(by_option, "sample room-1 2");
  for (const Explorer* explorer : {&by_setting, &by_option}) {
    EXPECT_FALSE(explorer->estimating.is_running());
    EXPECT_FALSE(explorer->is_answering());
    EXPECT_EQ(observe(*explorer, "estimate"), "none");
  }
}

TEST(Opening, AnOffsetOfMapBThatAPersonSetStays) {
  Explorer explorer(estimating());
  perform(explorer, "sample room-1");
  perform(explorer, "offset-b 20");
  rest(explorer);
  EXPECT_EQ(observe(explorer, "estimate"), "found");
  EXPECT_EQ(explorer.settings().offset_b_ms, 20);
  EXPECT_EQ(explorer.walls_in_words(), "");
}

TEST(Opening, AWalksMapsLieAlongTheTrajectoryOfItsEstimate) {
  Explorer explorer(estimating());
  load(explorer, "sample metro-station 10");
  for (int i = 0; i < 20; ++i) explorer.update(0.02);
  EXPECT_TRUE(explorer.background.keys("solve ").empty() || explorer.estimating.found() != nullptr);
  rest(explorer);
  ASSERT_NE(explorer.estimating.found(), nullptr);
  EXPECT_EQ(explorer.loaded()->walk->get(), explorer.estimating.found()->walk);
}

TEST(Opening, AMapThatIsWarnedOfSaysSoAndItsThicknessIsMarked) {
  Explorer explorer;
  load(explorer, "sample metro-station 10");
  perform(explorer, "offset-b 24");
  rest(explorer);
  EXPECT_EQ(observe(explorer, "warning-b"), "");
  EXPECT_NE(observe(explorer, "consistency-b"), "");
  SolvedWalk doubtful = *explorer.loaded()->walk->get();
  doubtful.tracked_again = true;
  doubtful.contradiction = in_words(Contradiction{4, 7, 3.0}, 0);
  explorer.loaded()->walk->keep(std::make_shared<const SolvedWalk>(doubtful));
  perform(explorer, "colouring blur");
  perform(explorer, "offset-b 23");
  rest(explorer);
  const std::string warning = *observe(explorer, "warning-b"), thickness = *observe(explorer, "thickness-b");
  EXPECT_NE(warning.find("From 4 to 7 s"), std::string::npos) << warning;
  EXPECT_NE(thickness.find("the map does not agree with itself"), std::string::npos) << thickness;
  EXPECT_EQ(observe(explorer, "warning-a"), "") << "which was solved before";
}

/// The robot is stationary for the first 13.0 s. Its rig file is not given.
class RealTiltingScanner : public testing::Test {
 protected:
  void SetUp() override {
    if (data_.empty()) GTEST_SKIP() << "no real recordings: set SWEEPSCOPE_REAL_DATA to their folder";
  }
  const std::filesystem::path data_ = test::real_data();
  const std::string bag_ = (data_ / "guardian_tilt/guardian_tilt_B.bag").string();
};

TEST_F(RealTiltingScanner, IsAnsweredByThePartInWhichItWasStationary) {
  Explorer explorer(estimating());
  load(explorer, "open " + bag_);
  rest(explorer);
  EXPECT_EQ(observe(explorer, "estimate"), "found");
  const Loaded& loaded = *explorer.loaded();
  EXPECT_GT(loaded.recording.rig.mount.axis.y(), 0.99);
  ASSERT_TRUE(loaded.choices.window);
  EXPECT_EQ(loaded.choices.window->from_s, 0);
  EXPECT_NEAR(loaded.choices.window->to_s, 13.0, 0.3);
  EXPECT_EQ(explorer.settings().offset_b_ms, explorer.found_offset_ms());
  EXPECT_EQ(observe(explorer, "state-b"), "solved");
}

TEST_F(RealTiltingScanner, ThePageOfChoicesShowsWhenItWasStationary) {
  Explorer explorer;
  perform(explorer, "choose " + bag_);
  rest(explorer);
  const auto* choosing = explorer.page.choosing();
  ASSERT_TRUE(choosing != nullptr && choosing->survey);
  double stationary_s = 0;
  for (const MotionPart& part : choosing->survey->motion)
    if (!part.moved) stationary_s += part.end_s - part.begin_s;
  EXPECT_NEAR(stationary_s, 13.0, 1.0);
  EXPECT_NE(choosing->survey->mount_note.find("about y"), std::string::npos) << choosing->survey->mount_note;
}

TEST(Opening, ANewRecordingShowsNothingOfTheOneBefore) {
  Explorer explorer;
  load(explorer, "sample room-1 2");
  for (const char* line : {"offset-a 19", "offset-b 24", "colour-range 1 2", "time-window 0.5 1", "scan 20",
                           "chart-range 20 30", "box 0 0 0 1 1 1", "theme light"})
    perform(explorer, line);
  perform(explorer, "sample room-2 2");
  perform(explorer, "offset-a 21");  // of the new one, which is still being read
  rest(explorer);
  Settings expected;
  expected.theme = Theme::kLight;
  expected.offset_a_ms = 21;
  expected.camera_a = explorer.settings().camera_a;
  expected.camera_b = explorer.settings().camera_b;
  EXPECT_EQ(explorer.settings(), expected);
  EXPECT_FALSE(explorer.history().can_undo()) << "into the recording before";
}

TEST(Opening, AColouringThatAPersonChoseStays) {
  Explorer explorer(estimating());
  perform(explorer, "colouring time");
  perform(explorer, "sample room-1");
  rest(explorer);
  EXPECT_EQ(explorer.settings().colouring, ColourBy::kTime);
  EXPECT_NE(explorer.walls_in_words(), "");
}

TEST(Opening, TheSameFileIsOpenedAgainWithOtherStampsOrInPart) {
  SimulationOptions options;
  options.scene = "room-1";
  options.duration_s = 3;
  const auto made = simulate(options, Job());
  ASSERT_TRUE(made);
  const std::string bag = scratch("again.bag").string();
  ASSERT_TRUE(write_bag(*made, bag, Job()));
  Explorer explorer;
  load(explorer, "open " + bag);
  load(explorer, "reopen receive-stamps");
  ASSERT_NE(explorer.loaded(), nullptr);
  EXPECT_EQ(explorer.loaded()->choices.stamps, StampSource::kReceive);
  EXPECT_EQ(explorer.loaded()->choices.file, bag);
  EXPECT_FALSE(explorer.perform("reopen stationary-part")) << "it was stationary all the time";
  load(explorer, "sample room-1 2");
  EXPECT_FALSE(explorer.perform("reopen header-stamps")) << "a sample has no file";
  std::filesystem::remove(bag);
}

TEST(Ranges, ThatEndBeforeTheyBeginAreRefusedWithTheReason) {
  Explorer explorer;
  load(explorer, "sample room-1 2");
  for (const char* line :
       {"colour-range 5 2", "slab 2 1", "slab 1 1", "time-window 2 1", "chart-range 5 1"}) {
    const auto done = explorer.perform(line);
    ASSERT_FALSE(done) << line;
    EXPECT_NE(done.error().message.find("must end above its beginning"), std::string::npos) << line;
  }
  for (const char* line : {"colour-range 0 0", "colour-range 1 2", "time-window 0 0"})
    perform(explorer, line);
}

TEST(Drags, KeepThePathThatTheyBeganWith) {
  Explorer explorer;
  load(explorer, "sample metro-station 5");
  perform(explorer, "offset-a 19");
  perform(explorer, "offset-b 24");
  rest(explorer);
  const SolvedMapPtr before = explorer.pane(Side::kA).request->placement.map;
  const ColourSpan span = explorer.maps.shown_span();
  explorer.maps.hold(true);
  perform(explorer, "offset-a 23");  // nearer to the path of map B
  explorer.update(0.02);
  EXPECT_EQ(explorer.pane(Side::kA).request->placement.map, before);
  EXPECT_EQ(explorer.maps.shown_span().from, span.from);
  EXPECT_EQ(explorer.maps.shown_span().to, span.to);
  EXPECT_FALSE(explorer.places_hold());
}

TEST(BlurRange, ReachesTheThickerMapAndKeepsTheThinnerOneApart) {
  const auto end = [](double a_mm, double b_mm) {
    MapThickness a, b;
    a.median_m = a_mm * 1e-3;
    b.median_m = b_mm * 1e-3;
    return blur_span(a, b).to;
  };
  EXPECT_EQ(end(105, 24), 100);
  EXPECT_EQ(end(24, 105), 100);
  EXPECT_EQ(end(404, 32), 150);
  EXPECT_EQ(end(12, 4), 20);
  EXPECT_EQ(end(30, 30), 30);
}

}  // namespace
}  // namespace sweepscope::ui
