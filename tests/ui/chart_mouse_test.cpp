// The charts by mouse: handles, zoom, pan, values, and the curve that grows.
#include "ui/panes/chart_mouse.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/charts/curve_charts.hpp"
#include "ui/model/growing_curve.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

ChartLayout layout_of(double from_ms, double to_ms) {
  ChartLayout layout;
  layout.plot = {100, 50, 400, 200};
  layout.x = {from_ms, to_ms};
  return layout;
}

TEST(Handles, TheOneOnTopIsTakenWhereBothCoincide) {
  Settings settings;
  settings.offset_a_ms = settings.offset_b_ms = 20;
  const ChartLayout layout = layout_of(0, 40);
  for (const Side top : kBothSides) {
    EXPECT_EQ(handle_under(layout, settings, top, {303, 248}, 1), top) << "on the grips";
    EXPECT_EQ(handle_under(layout, settings, top, {298, 100}, 1), top) << "on the lines";
  }
}

TEST(Handles, TheNearerOneIsTakenAndNoneBesideThem) {
  Settings settings;
  settings.offset_a_ms = 10;
  settings.offset_b_ms = 30;
  const ChartLayout layout = layout_of(0, 40);
  EXPECT_EQ(handle_under(layout, settings, Side::kB, {202, 100}, 1), Side::kA);
  EXPECT_EQ(handle_under(layout, settings, Side::kA, {397, 100}, 1), Side::kB);
  EXPECT_FALSE(handle_under(layout, settings, Side::kA, {300, 100}, 1));
}

TEST(ZoomedRange, KeepsTheOffsetUnderTheMouseAndStaysWithinAllThereIs) {
  const AxisRange all{-60, 60};
  const auto closer = zoomed_range(all, 2, 30, all);
  ASSERT_TRUE(closer);
  EXPECT_DOUBLE_EQ(closer->length(), 60);
  EXPECT_DOUBLE_EQ((30 - closer->from) / closer->length(), (30 - all.from) / all.length());
  EXPECT_FALSE(zoomed_range(*closer, 0.4, 30, all)) << "all of it again";
  const auto at_the_end = zoomed_range({40, 60}, 0.5, 60, all);
  EXPECT_DOUBLE_EQ(at_the_end->to, 60);
  EXPECT_DOUBLE_EQ(at_the_end->from, 20);
  EXPECT_GE(zoomed_range({1, 1.1}, 1000, 1, all)->length(), 0.1);
}

TEST(GrowingCurve, ACandidateThatIsComputedAgainReplacesWhatItWas) {
  GrowingCurve curve;
  for (const double cost_m : {0.3, 0.1}) {
    CurvePoint point;
    point.offset_s = 0.02;
    point.capped_cost_m = cost_m;
    curve.add(point);
  }
  const Estimate so_far = curve.so_far();
  ASSERT_EQ(so_far.curve.size(), 1U);
  EXPECT_EQ(so_far.curve[0].capped_cost_m, 0.1);
}

// Their costs have other levels: together they would be a sawtooth.
TEST(GrowingCurve, ShowsOneCoarseSearchAtATimeTheNewOneOnceItHasHalfOfTheCandidates) {
  GrowingCurve curve;
  const auto add = [&](double offset_s, double cost_m) {
    CurvePoint point;
    point.offset_s = offset_s;
    point.capped_cost_m = cost_m;
    curve.add(point);
  };
  curve.begin();
  for (int i = 0; i < 5; ++i) add(0.002 * i, 0.2);
  curve.begin();
  add(0.001, 0.1);
  add(0.003, 0.1);
  ASSERT_EQ(curve.so_far().curve.size(), 5u);
  for (const CurvePoint& point : curve.so_far().curve) EXPECT_EQ(point.capped_cost_m, 0.2);
  add(0.005, 0.1);
  ASSERT_EQ(curve.so_far().curve.size(), 3u);
  for (const CurvePoint& point : curve.so_far().curve) EXPECT_EQ(point.capped_cost_m, 0.1);
  EXPECT_EQ(curve.size(), 8u);
}

TEST(GrowingCurve, LeavesOutWhatIsTriedSecondsAwayAndWouldSqueezeTheOthers) {
  GrowingCurve curve(0.24);
  CurvePoint point;
  point.capped_cost_m = 0.1;
  for (const double offset_s : {-0.02, 0.2, -9.9}) {
    if (offset_s < -1) curve.begin();
    point.offset_s = offset_s;
    curve.add(point);
  }
  ASSERT_EQ(curve.so_far().curve.size(), 2u);
  EXPECT_EQ(curve.so_far().curve.front().offset_s, -0.02);
}

TEST(GrowingCurve, HasTheCoarseSearchFirstAndThenTheMethodsCandidatesAscending) {
  GrowingCurve curve;
  CurvePoint point;
  for (const double offset_s : {0.02, -0.01}) {
    point.offset_s = offset_s;
    point.capped_cost_m = 0.1;
    curve.add(point);
  }
  EXPECT_EQ(curve.so_far().method, Method::kDirect);
  ASSERT_EQ(curve.so_far().curve.size(), 2u);
  EXPECT_EQ(curve.so_far().curve.front().offset_s, -0.01);
  point.offset_s = 0.024;
  point.capped_cost_m.reset();
  point.e_m = 0.02;
  curve.add(point);
  EXPECT_EQ(curve.so_far().curve.size(), 1u) << "no gaps where the coarse search has no e";
  EXPECT_FALSE(curve.so_far().offset_s);
}

class Charts : public testing::Test {
 protected:
  void SetUp() override {
    run("sample room-1\noffset-a 10\noffset-b 24\nestimate\nwait estimated\nwait solved\n");
  }
  void run(const std::string& lines) {
    const auto done = run_script(ui_, *parse_script(lines, "test"), 300);
    ASSERT_TRUE(done) << done.error().message;
  }
  const Settings& settings() { return ui_.explorer().settings(); }
  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(1200, 800);
  Ui ui_{*context_, Ui::Options()};
};

TEST_F(Charts, TheWheelZoomsADragPansAndADoubleClickShowsAll) {
  run("mouse move \"chart 0\" at 0.8 0.3\nwheel 4");
  const double from_ms = settings().chart_from_ms, to_ms = settings().chart_to_ms;
  ASSERT_LT(from_ms, to_ms);
  EXPECT_LT(to_ms - from_ms, 70);
  run("drag \"chart 0\" at 0.1 0.2 to \"chart 0\" at 0.3 0.2");
  EXPECT_LT(settings().chart_from_ms, from_ms);
  EXPECT_NEAR(settings().chart_to_ms - settings().chart_from_ms, to_ms - from_ms, 0.01);
  EXPECT_EQ(settings().offset_a_ms, 10) << "a drag beside the handles moves none";
  run("double-click \"chart 0\" at 0.1 0.2");
  EXPECT_EQ(settings().chart_to_ms, settings().chart_from_ms);
  run("chart-range 20 28\nexpect chart-range is \"20 28\"\nundo\nexpect chart-range is \"0 0\"");
}

TEST_F(Charts, AClickOnAHandleChangesNothingAndADragMovesItByWhatTheMouseMoves) {
  const double b_ms = settings().offset_b_ms;
  run("click \"handle a\" at 0.9 0.8\nexpect offset-a is 10");
  run("offset-a 24\nmouse move \"handle b\" at 0.5 0.7\nmouse down\nmouse move \"chart 0\" at 0.3 0.9\nmouse up");
  EXPECT_EQ(settings().offset_b_ms, b_ms) << "A was set last: it is on top";
  EXPECT_LT(settings().offset_a_ms, 24);
}

TEST_F(Charts, AClickBesideTheHandlesBringsTheNearestAndADoubleClickNone) {
  run("click \"chart 0\" at 0.1 0.3");
  EXPECT_LT(settings().offset_a_ms, -40);
  EXPECT_EQ(settings().offset_b_ms, 24);
  const double a_ms = settings().offset_a_ms;
  run("click \"chart 0\" at 0.9 0.3\nundo\nexpect offset-b is 24");
  run("double-click \"chart 0\" at 0.7 0.8");
  EXPECT_EQ(settings().offset_a_ms, a_ms);
  EXPECT_EQ(settings().offset_b_ms, 24);
}

TEST_F(Charts, AHandleSnapsToTheOffsetFound) {
  const double found_ms = *ui_.explorer().found_offset_ms();
  run("offset-b 30\nframes 2");
  const double px_per_ms = (ui_.anchor("handle b")->left - ui_.anchor("handle a")->left) / 20;
  const double away_px = (found_ms - 30) * px_per_ms + 2;
  run(fmt::format("drag \"handle b\" by {:.1f} 0", away_px));
  EXPECT_EQ(settings().offset_b_ms, found_ms);
  run("offset-b 30\nframes 2");
  run(fmt::format("drag \"handle b\" by {:.1f} 0", away_px + 20));
  EXPECT_NE(settings().offset_b_ms, found_ms);
}

/// One frame with all of these events, as a fast hand or a slow machine sends them.
TEST_F(Charts, AClickTurnsNoMapAndMovesNoHandleHoweverFastTheMouseCame) {
  const auto at = [&](const std::string& name) {
    const PixelRect place = *ui_.anchor(name);
    return std::pair{place.left + place.width / 2, place.top + 0.8 * place.height};
  };
  const Settings before = settings();
  for (const std::string name : {"map a", "handle a", "handle b", "map b"}) {
    const auto [x, y] = at(name);
    const std::vector<InputEvent> all{InputEvent::move(x - 300, y - 40), InputEvent::move(x, y),
                                      InputEvent::press(0, true, 0),     InputEvent::move(x + 2, y + 1),
                                      InputEvent::press(0, false, 0),    InputEvent::move(x + 400, y + 90)};
    ui_.frame(all, 1.0 / 60);
    for (int frame = 0; frame < 10; ++frame) ui_.frame({}, 1.0 / 60);
    EXPECT_EQ(settings(), before) << name;
  }
}

TEST_F(Charts, AHandleStaysWhereItIsLetGoHoweverFastTheMouseWasThere) {
  const PixelRect plot = *ui_.anchor("chart 0");
  run("mouse move \"handle a\" at 0.5 0.8\nmouse down\nmouse move \"chart 0\" at 0.2 0.9");
  const double on_the_way_ms = settings().offset_a_ms;
  const std::array last{InputEvent::move(plot.left + 0.4 * plot.width, plot.top + 0.9 * plot.height),
                        InputEvent::press(0, false)};
  ui_.frame(last, 1.0 / 60);  // both in one frame
  run("frames 3");
  EXPECT_GT(settings().offset_a_ms, on_the_way_ms + 10);
}

TEST_F(Charts, TheAxisStaysWhileAHandleIsDragged) {
  const PixelRect a = *ui_.anchor("handle a"), b = *ui_.anchor("handle b");
  run("mouse move \"handle a\"\nmouse down\nmouse move \"chart 0\" at 0.05 0.9\nframes 1");
  EXPECT_LT(ui_.anchor("handle a")->left, a.left - 50);
  EXPECT_EQ(ui_.anchor("handle b")->left, b.left);
  run("mouse up");
}

TEST_F(Charts, TheValueUnderTheMouseIsShownAtTheNearestCandidate) {
  run("mouse move \"chart 0\" at 0.2 0.3");
  ASSERT_TRUE(ui_.anchor("chart value 0"));
  const PixelRect plot = *ui_.anchor("chart 0");
  EXPECT_NEAR(ui_.anchor("chart value 0")->left, plot.left + 0.2 * plot.width, 10);
  run("mouse move \"map a\"");
  EXPECT_FALSE(ui_.anchor("chart value 0"));
}

TEST_F(Charts, TheCurveOfTheDirectMethodIsItsCappedCostWithoutAFailure) {
  EXPECT_EQ(ui_.explorer().estimating.charted(), ui_.explorer().estimating.found());
  EXPECT_GT(ui_.explorer().estimating.found()->curve.size(), 30u);
  const auto charts = curve_charts(*ui_.explorer().estimating.found(), {}, kDarkStyle);
  ASSERT_EQ(charts.size(), 1u);
  for (const auto& y : charts[0].series[0].y) EXPECT_TRUE(y);
}

}  // namespace
}  // namespace sweepscope::ui
