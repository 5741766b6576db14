// What the panes show from frame to frame while points are placed and drawn anew: whole pictures alone.
#include <gtest/gtest.h>

#include <thread>

#include "tests/image_part.hpp"
#include "ui/script/script.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kFrame_s = 1.0 / 60;

/// The pictures of a pane in a row, each different from the one before, and the frames at which they came.
struct Strip {
  std::vector<Image> pictures;
  std::vector<int> frames;

  void add(Image picture, int frame) {
    if (!pictures.empty() && pictures.back() == picture) return;
    pictures.push_back(std::move(picture));
    frames.push_back(frame);
  }
};

class WholePictures : public testing::Test {
 protected:
  void SetUp() override {
    run("sample room-1\nclose-up off\nheights all\nfit-view\ntrajectory off\nwait solved\n");
    ASSERT_TRUE(ui_.shows_all_points());
    ASSERT_GT(ui_.explorer().pane(Side::kA).full->points->size(), 90000u);  // several slices
  }
  void run(const std::string& lines) {
    const auto done = run_script(ui_, *parse_script(lines, "test"), 300);
    ASSERT_TRUE(done) << done.error().message;
  }
  /// Frames until all points are shown, the present one first.
  std::pair<Strip, Strip> strips_to_rest() {
    std::pair<Strip, Strip> strips;
    // What was asked for is seen by the explorer in the next frame.
    for (int frame = 0; frame < 2 || !ui_.explorer().at_rest() || !ui_.shows_all_points(); ++frame) {
      if (frame > 0) ui_.frame({}, kFrame_s);
      const Image all = ui_.screenshot();
      strips.first.add(test::part_of(all, *ui_.anchor("map a")), frame);
      strips.second.add(test::part_of(all, *ui_.anchor("map b")), frame);
      if (ui_.explorer().background.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return strips;
  }

  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(1200, 800);
  Ui ui_{*context_,
         {.explorer = {}, .display_scale = 1, .recent_list = {}, .preferences = {}, .draw_budget_s = 0}};
};

TEST_F(WholePictures, AnotherOffsetGivesTheOldTheThinnedAndTheNewOneAndNothingBetween) {
  (void)ui_.explorer().perform("offset-b 20");
  const auto [a, b] = strips_to_rest();
  // The old picture, one or two thinned ones, and the new one; slices would make dozens.
  EXPECT_GE(b.pictures.size(), 3u);
  EXPECT_LE(b.pictures.size(), 4u);
  EXPECT_EQ(a.pictures.front(), a.pictures.back());  // A is as it was
  EXPECT_EQ(a.frames[1], b.frames[1]);               // and was thinned together with B
  EXPECT_EQ(a.frames.back(), b.frames.back());       // and drawn whole together with it
}

TEST_F(WholePictures, AnotherColouringChangesBothMapsInTheSameFrames) {
  for (const char* line : {"colouring intensity", "colouring blur"}) {
    (void)ui_.explorer().perform(line);
    const auto [a, b] = strips_to_rest();
    EXPECT_GE(a.pictures.size(), 3u);
    EXPECT_LE(a.pictures.size(), 4u) << line;  // blur: its thinned points are grey at first
    EXPECT_EQ(a.frames, b.frames) << line;
  }
}

TEST_F(WholePictures, ACameraThatIsMovedTakesBothMapsAlongInTheSameFrame) {
  const PixelRect place = *ui_.anchor("map b");
  const double x = place.left + place.width / 2, y = place.top + place.height / 2;
  const std::array press{InputEvent::move(x, y)}, hold{InputEvent::press(0, true)};
  const std::array move{InputEvent::move(x + 40, y + 10)}, release{InputEvent::press(0, false)};
  ui_.frame(press, kFrame_s);
  ui_.frame(hold, kFrame_s);
  const Image before = ui_.screenshot();
  ui_.frame(move, kFrame_s);
  const Image after = ui_.screenshot();
  for (const char* pane : {"map a", "map b"})
    EXPECT_NE(test::part_of(before, *ui_.anchor(pane)), test::part_of(after, *ui_.anchor(pane))) << pane;
  ui_.frame(release, kFrame_s);
  const auto [a, b] = strips_to_rest();
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.pictures.size(), 2u);
}

TEST_F(WholePictures, AreFittedAgainWhenThePaneChangesItsShapeUntilThePersonMovesTheView) {
  const ViewPoint wide = ui_.explorer().settings().camera_a;
  run("panels off\nframes 3");
  const ViewPoint fitted = ui_.explorer().settings().camera_a;
  EXPECT_NE(fitted, wide);
  run("fit-view\nexpect panels is off");
  EXPECT_EQ(ui_.explorer().settings().camera_a, fitted);
  run("pan 0.1 0\npanels on\nframes 3");
  EXPECT_EQ(ui_.explorer().settings().camera_a.height_m, fitted.height_m);
  run("fit-view\npanels off\nframes 3");
  EXPECT_EQ(ui_.explorer().settings().camera_a, fitted);
}

TEST_F(WholePictures, AViewThatNobodyMovedFitsFromWhereverItIsLookedAt) {
  run("look isometric\nframes 3");
  const ViewPoint turned = ui_.explorer().settings().camera_a;
  run("fit-view");
  EXPECT_EQ(ui_.explorer().settings().camera_a, turned);
  run("zoom 2\nlook top\nframes 3");
  EXPECT_EQ(ui_.explorer().settings().camera_a.height_m, turned.height_m / 2) << "a person's zoom stays";
}

}  // namespace
}  // namespace sweepscope::ui
