#include "ui/preferences.hpp"

#include "tests/folder_test.hpp"
#include "ui/ui.hpp"

namespace sweepscope::ui {
namespace {

using PreferencesTest = test::FolderTest;

TEST_F(PreferencesTest, TheLookIsKeptAndNothingElse) {
  Settings settings;
  settings.theme = Theme::kLight;
  settings.layout = Layout::kSwipe;
  settings.ui_scale = 1.5;
  settings.left_width_px = 321;
  settings.map_share = 0.3;
  settings.time_s = 5;
  settings.offset_a_ms = 19;
  settings.camera_a.height_m = 3;
  const auto file = folder_ / "state/preferences";
  write_preferences(file, {settings, 1300, 800});
  const Preferences read = read_preferences(file);
  EXPECT_EQ(read.look.theme, Theme::kLight);
  EXPECT_EQ(read.look.layout, Layout::kSwipe);
  EXPECT_EQ(read.look.ui_scale, 1.5);
  EXPECT_EQ(read.look.left_width_px, 321);
  EXPECT_EQ(read.look.map_share, 0.3);
  EXPECT_EQ(read.look.time_s, -1);
  EXPECT_EQ(read.look.offset_a_ms, 0);
  EXPECT_EQ(read.look.camera_a, Settings().camera_a);
  EXPECT_EQ(read.width_px, 1300);
  EXPECT_EQ(read.height_px, 800);
}

TEST_F(PreferencesTest, LinesThatMeanNothingAreSkipped) {
  const Preferences read =
      parse_preferences("theme\ntheme purple\noffset-a 3\nquit\nwindow 5\nwindow -3 8\n\"\npanels off\n");
  Settings expected;
  expected.panels = false;
  EXPECT_EQ(read, (Preferences{expected, 0, 0}));
  EXPECT_EQ(read_preferences(folder_ / "none"), Preferences());
  EXPECT_EQ(read_preferences({}), Preferences());
}

TEST_F(PreferencesTest, TheNextExplorerLooksAsTheLastOneDid) {
  const auto context = gl::make_offscreen_context(1000, 700);
  Ui::Options options;
  options.preferences = folder_ / "preferences";
  {
    Ui ui(**context, options);
    ui.frame({}, 0.1);
    ASSERT_TRUE(ui.explorer().perform("theme light"));
    ASSERT_TRUE(ui.explorer().perform("criteria off"));
  }
  EXPECT_EQ(read_preferences(options.preferences).width_px, 1000);
  Ui again(**context, options);
  EXPECT_EQ(again.explorer().settings().theme, Theme::kLight);
  EXPECT_FALSE(again.explorer().settings().criteria);
  EXPECT_FALSE(again.explorer().history().can_undo());
}

}  // namespace
}  // namespace sweepscope::ui
