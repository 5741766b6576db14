// Playback, edges that can be dragged, the clipping box and the colour range.
#include "ui/model/playback.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ui/explorer/observables.hpp"
#include "ui/panes/layout.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

class Played : public testing::Test {
 protected:
  void SetUp() override { run("sample room-1\nwait solved"); }
  void run(const std::string& lines) {
    const auto script = parse_script(lines, "test");
    ASSERT_TRUE(script) << script.error().message;
    const auto done = run_script(ui_, *script, 120);
    ASSERT_TRUE(done) << done.error().message;
  }
  double now(const std::string& name) { return std::stod(*observe(ui_.explorer(), name)); }
  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(1200, 800);
  Ui ui_{*context_, Ui::Options()};
};

TEST_F(Played, TheScanOfAMomentIsTheLastThatBeganBeforeIt) {
  const Placement placement = ui_.explorer().pane(Side::kB).request->placement;
  const Loaded& loaded = *placement.loaded;
  const auto& scans = loaded.recording.scans;
  const auto began_s = [&](std::size_t i) { return scans[i].first_beam_s - scans[0].first_beam_s; };
  EXPECT_EQ(played_scan(placement, 0).scan, 0U);
  EXPECT_EQ(played_scan(placement, began_s(7) + 0.01).scan, 7U);
  EXPECT_EQ(played_scan(placement, began_s(8) + 1e-6).scan, 8U);
  EXPECT_EQ(played_scan(placement, 1e6).scan, scans.size() - 1);
  // Its points are those of the map: a beam is where the map has it.
  const PlayedScan played = played_scan(placement, began_s(40) + 0.001);
  const std::size_t first = loaded.beams.first_point[40], end = loaded.beams.first_point[41];
  ASSERT_EQ(played.points_m.size(), end - first);
  const auto all = place_beams(loaded.beams, placement.map->path, placement.offset_s);
  EXPECT_EQ(played.points_m.front(), all[first]);
  EXPECT_EQ(played.points_m.back(), all[end - 1]);
}

TEST_F(Played, TheScannerIsDrawnAtTheMomentThatIsPlayed) {
  const Recording& recording = ui_.explorer().loaded()->recording;
  const double first_s = recording.scans.front().first_beam_s;
  Settings settings;
  EXPECT_GT(scanner_time_s(recording, settings), recording.scans.back().first_beam_s);
  settings.time_to_s = 3;
  EXPECT_DOUBLE_EQ(scanner_time_s(recording, settings), first_s + 3);
  settings.time_s = 0;
  EXPECT_DOUBLE_EQ(scanner_time_s(recording, settings), first_s);
}

TEST_F(Played, TimeGoesOnWhilePlayingAndNothingIsDrawnAnewWhilePaused) {
  run("frames 60");
  EXPECT_FALSE(ui_.animates());
  run("key R\nexpect playing is on");
  const double begin_s = now("time");
  EXPECT_TRUE(ui_.animates());
  run("frames 60");
  EXPECT_NEAR(now("time"), begin_s + 1, 0.1);
  run("key R\nexpect playing is off");
  const double paused_s = now("time");
  run("frames 60");
  EXPECT_EQ(now("time"), paused_s);
  EXPECT_FALSE(ui_.animates());
  run("play-speed 2\nplay on");
  const double again_s = now("time");
  run("frames 30");
  EXPECT_NEAR(now("time"), again_s + 1, 0.15);
}

TEST_F(Played, EndsAtTheEndAndBeginsAgain) {
  run("time 4.4\nplay on\nframes 60\nexpect playing is off");
  EXPECT_NEAR(now("time"), ui_.explorer().loaded()->duration_s(), 1e-9);
  run("play on\nframes 5\nexpect playing is on\nexpect time below 1\ntime -1\nframes 1\nexpect playing is off");
  EXPECT_FALSE(ui_.anchor("time"));
}

TEST_F(Played, TheSliderIsDraggedAndTheScanIsSeenInBothMaps) {
  run("time 0\nframes 3");
  const Image before = ui_.screenshot();
  run("drag \"time\" at 0 0.5 to \"time\" at 0.5 0.5\nwait solved");
  EXPECT_NEAR(now("time"), ui_.explorer().loaded()->duration_s() / 2, 0.05);
  const Image after = ui_.screenshot();
  for (const char* map : {"map a", "map b"}) {
    const PixelRect place = ui_.anchor(map).value();
    int differ = 0;
    for (int y = static_cast<int>(place.top) + 2; y < static_cast<int>(place.bottom()) - 2; ++y)
      for (int x = static_cast<int>(place.left) + 2; x < static_cast<int>(place.right()) - 2; ++x)
        differ += std::equal(before.pixel(x, y), before.pixel(x, y) + 3, after.pixel(x, y)) ? 0 : 1;
    EXPECT_GT(differ, 200) << map;
  }
}

TEST_F(Played, EdgesAreDraggedAndADoubleClickPutsThemBack) {
  const double maps_px = ui_.anchor("map a")->width;
  run("drag \"splitter left\" by 60 0");
  EXPECT_NEAR(now("left-width"), 352, 2);
  EXPECT_NEAR(ui_.anchor("map a")->width, maps_px - 30, 2);
  run("drag \"splitter right\" by -40 0");
  EXPECT_NEAR(now("right-width"), 284, 2);
  const double charts_px = ui_.anchor("chart 0")->height;
  run("drag \"splitter charts\" by 0 -80");
  EXPECT_NEAR(ui_.anchor("chart 0")->height, charts_px + 80, 3);
  run("drag \"splitter maps\" by 70 0");
  EXPECT_GT(now("map-share"), 0.55);
  EXPECT_GT(ui_.anchor("map a")->width, ui_.anchor("map b")->width + 100);
  run("key Ctrl+Z\nexpect map-share is 0.5");
  for (const char* splitter : {"left", "right", "charts"})
    run(std::string("double-click \"splitter ") + splitter + "\"");
  EXPECT_NEAR(ui_.anchor("map a")->width, maps_px, 1);
}

TEST_F(Played, StackedMapsLieAboveEachOther) {
  run("layout stacked\nwait solved");
  const PixelRect a = ui_.anchor("map a").value(), b = ui_.anchor("map b").value();
  EXPECT_EQ(a.left, b.left);
  EXPECT_EQ(a.width, b.width);
  EXPECT_LT(a.bottom(), b.top);
  EXPECT_NEAR(a.height, b.height, 2);
  run("drag \"splitter maps\" by 0 -60");
  EXPECT_LT(now("map-share"), 0.45);
  EXPECT_LT(ui_.anchor("map a")->height, ui_.anchor("map b")->height);
}

TEST_F(Played, TheClippingBoxShowsThePointsInsideAndTheViewFitsIt) {
  run("heights all\nwait solved");
  const double all = now("points-b"), height_m = ui_.explorer().settings().camera_a.height_m;
  run("box -1 -1 -1 1.5 1.5 1\nwait solved");
  const auto& cloud = *ui_.explorer().pane(Side::kB).full;
  ASSERT_GT(cloud.points->xyz_m.size(), 10U);
  EXPECT_LT(now("points-b"), all / 2);
  for (const auto& p_m : cloud.points->xyz_m) {
    EXPECT_LE(std::max(std::abs(p_m[2]), 0.0f), 1.0f);
    EXPECT_TRUE(p_m[0] >= -1 && p_m[0] <= 1.5f && p_m[1] >= -1 && p_m[1] <= 1.5f);
  }
  EXPECT_LT(ui_.explorer().settings().camera_a.height_m, 0.8 * height_m);
  EXPECT_TRUE(ui_.anchor("box 0"));
  run("box 0 0 0 0 0 0\nwait solved");
  EXPECT_EQ(now("points-b"), all);
  run("box 2 2 2 1 1 1\nexpect box is 1 1 1 2 2 2");
}

TEST_F(Played, TheColourRangeIsTheGivenOneInEveryColouring) {
  run("colour-range -0.5 1.5\nframes 2");
  EXPECT_EQ(ui_.explorer().maps.shown_span().from, -0.5);
  EXPECT_EQ(ui_.explorer().maps.shown_span().to, 1.5);
  run("layout difference\noffset-a 19\ncolour-range 0 40\nwait solved");
  EXPECT_EQ(ui_.explorer().maps.shown_span().to, 40);
  run("colour-range 0 0\nwait solved");
  EXPECT_NE(ui_.explorer().maps.shown_span().to, 40);
}

TEST_F(Played, TheTooltipOfAChartLeavesItsTitleLegible) {
  const PixelRect title = ui_.anchor("chart title 0").value();
  const auto at_title = [&] {
    const Image image = ui_.screenshot();
    std::vector<std::uint8_t> pixels;
    for (int y = static_cast<int>(title.top); y < static_cast<int>(title.bottom()) - 1; ++y)
      pixels.insert(pixels.end(), image.pixel(static_cast<int>(title.left), y),
                    image.pixel(static_cast<int>(title.right()), y));
    return pixels;
  };
  run("mouse move 5 795\nframes 5");
  const auto before = at_title();
  run("hover \"chart title 0\"");
  EXPECT_EQ(at_title(), before);
  run("estimate\nwait solved\nmouse move 5 795\nframes 5");
  const auto estimated = at_title();
  run("hover \"chart 0\" at 0.3 0.02");
  EXPECT_EQ(at_title(), estimated);
}

TEST(ShownTable, OnLightGroundEndsBeforeTheBrightestColours) {
  for (const char* name : {"viridis", "cividis", "grey"}) {
    const Colour last = shown_table(name, true).back(), whole = shown_table(name, false).back();
    const auto brightness = [](const Colour& c) { return 0.3 * c.red + 0.6 * c.green + 0.1 * c.blue; };
    EXPECT_LT(brightness(last), brightness(whole) - 15) << name;
    EXPECT_EQ(shown_table(name, true).front(), shown_table(name, false).front()) << name;
  }
  EXPECT_EQ(shown_table("turbo", true), shown_table("turbo", false));
}

TEST(LayOut, NothingOverlapsAtAnySizeScaleAndWidthOfThePanels) {
  for (const auto& [width, height, scale] :
       {std::tuple{1024.0, 768.0, 1.0}, std::tuple{1920.0, 1080.0, 2.0}, std::tuple{1024.0, 768.0, 2.0},
        std::tuple{3840.0, 2160.0, 2.0}, std::tuple{1400.0, 900.0, 2.0}, std::tuple{390.0, 844.0, 1.0},
        std::tuple{390.0, 640.0, 1.0}}) {
    for (const double given : {0.0, 50.0, 300.0, 4000.0}) {
      Settings settings;
      settings.left_width_px = settings.right_width_px = settings.charts_height_px = given;
      settings.time_s = 1;
      for (const Layout layout : {Layout::kSideBySide, Layout::kStacked}) {
        settings.layout = layout;
        const Places p = lay_out(width, height, scale, settings, true, 0);
        EXPECT_LE(p.left.right(), p.maps.left);
        EXPECT_LE(p.maps.right(), p.right.left);
        EXPECT_LE(p.maps.bottom(), p.playback.top);
        EXPECT_LE(p.playback.bottom(), p.criteria.top + 1);
        EXPECT_LE(p.criteria.bottom(), (p.tabs.height > 0 ? p.tabs.top : p.status.top) + 1);
        EXPECT_LE(p.tabs.bottom(), p.status.top + 1);
        EXPECT_TRUE(p.left.width > 0 || p.tabs.height > 0) << "the panels can be reached";
        EXPECT_GT(p.criteria.height, 80) << "the handles are there";
        const MapPlaces maps = lay_out_maps(p.maps, scale, layout, 0.5);
        for (const PixelRect& picture : {maps.picture_a, maps.picture_b}) {
          EXPECT_GT(picture.width, 60) << width << " " << scale << " " << given;
          EXPECT_GT(picture.height, 30) << height << " " << scale << " " << given;
          EXPECT_LE(picture.right(), p.maps.right());
          EXPECT_LE(picture.bottom(), p.maps.bottom());
        }
      }
    }
  }
}

}  // namespace
}  // namespace sweepscope::ui
