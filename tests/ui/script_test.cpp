#include "ui/script/script.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <set>

#include "core/io/atomic_file.hpp"
#include "render/images/image_difference.hpp"
#include "tests/program.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/host/imgui_host.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/window_loop.hpp"

namespace sweepscope::ui {
namespace {

/// An explorer without a display, told what to do line by line.
class Headless : public testing::Test {
 protected:
  Result<void> run(const std::string& lines) {
    const auto script = parse_script(lines, "test", false);
    if (!script) return tl::unexpected(script.error());
    return run_script(ui_, *script, 120);
  }
  void expect_runs(const std::string& lines) {
    const auto done = run(lines);
    EXPECT_TRUE(done) << done.error().message;
  }
  std::string now(const std::string& name) { return *observe(ui_.explorer(), name); }
  std::unique_ptr<gl::Context> context_ = *make_context();
  Ui ui_{*context_, Ui::Options()};

 private:
  static Result<std::unique_ptr<gl::Context>> make_context() { return gl::make_offscreen_context(1200, 800); }
};

constexpr const char* kRoom = "sample room-1\nwait solved\n";

TEST_F(Headless, AnExpectationThatFailsNamesFileLineAndWhatThereIsInstead) {
  const auto done = run("theme light\nexpect theme is dark\n");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ExitCode::kImageDiffers);
  EXPECT_EQ(done.error().message, "test:2: expected theme is \"dark\", but it is \"light\"");
}

TEST_F(Headless, ALineThatMeansNothingIsWrongUsageWithItsPlace) {
  for (const char* line : {"dance", "click \"button of doom\"", "key Hyper+J", "expect nonsense is 1",
                           "wait dinner", "mouse wiggle", "drag 1 2 3 4", "frames many"}) {
    const auto done = run(std::string("\n") + line + "\n");
    ASSERT_FALSE(done) << line;
    EXPECT_EQ(done.error().code, ExitCode::kWrongUsage) << line;
    EXPECT_EQ(done.error().message.find("test:2: "), 0u) << done.error().message;
  }
}

TEST_F(Headless, ThePictureIsTheSameRunAfterRunAndAnotherThemeIsAnother) {
  expect_runs("frames 5");
  const Image first = ui_.screenshot();
  const auto context = gl::make_offscreen_context(1200, 800);
  Ui again(**context, Ui::Options());
  for (int i = 0; i < 9; ++i) again.frame({}, 1.0 / 60);
  EXPECT_EQ(again.screenshot(), first);
  expect_runs("theme light");
  EXPECT_FALSE(compare_images(ui_.screenshot(), first).passes);
}

TEST_F(Headless, TheSampleIsOneClickAway) {
  expect_runs("click \"button sample room-1\"\nwait solved\nexpect recording is room-1\n");
}

TEST_F(Headless, DraggingAHandleMovesItsOffsetAsOneStepOfUndo) {
  expect_runs(kRoom);
  expect_runs("offset-a -20\noffset-b 20");
  expect_runs("drag \"handle a\" by 60 0");
  const double a = ui_.explorer().settings().offset_a_ms;
  EXPECT_GT(a, -20);
  EXPECT_LT(a, 0);
  EXPECT_EQ(ui_.explorer().settings().offset_b_ms, 20);
  expect_runs("undo");
  EXPECT_EQ(ui_.explorer().settings().offset_a_ms, -20);
}

TEST_F(Headless, AnOffsetIsTypedAfterADoubleClick) {
  expect_runs(kRoom);
  expect_runs("double-click offset-b\nkey Ctrl+A\ntype 12.5\nkey Enter\nexpect offset-b is 12.5");
}

TEST_F(Headless, MouseKeysPaletteAndScriptGiveTheSameCommand) {
  expect_runs(kRoom);
  expect_runs("key T\nexpect theme is light");
  expect_runs("key Ctrl+P\ntype \"theme dark\"\nkey Enter\nexpect theme is dark");
  expect_runs("click \"menu View\"\nclick \"menu theme\"\nexpect theme is light");
  expect_runs("theme\nexpect theme is dark");
}

TEST_F(Headless, ThePanelTurnsEachDepthCueOnAndOff) {
  expect_runs(kRoom);
  expect_runs("mouse move colouring\nwheel -50\nframes 3");  // to the panel's end
  for (const std::string cue : {"lighting", "splats", "grid", "scanner"})
    for (const std::string choice : {"on", "off", "auto"})
      expect_runs("click " + cue + "\nclick \"" + cue + " " + choice + "\"\nexpect " + cue + " is " + choice);
}

TEST_F(Headless, ThePaletteFindsACommandByItsWords) {
  expect_runs(kRoom);
  expect_runs("key Ctrl+P\ntype isomet\nkey Enter\n");
  EXPECT_NEAR(ui_.explorer().settings().camera_a.elevation_deg, 35.264, 1e-6);
}

TEST_F(Headless, KeysAreWordsWhileTextIsTyped) {
  expect_runs("ask open\ntype t\nkey T\nexpect theme is dark\nkey Escape");
}

TEST_F(Headless, TheMouseTurnsMovesAndZoomsTheView) {
  expect_runs(kRoom);
  const ViewPoint before = ui_.explorer().settings().camera_a;
  expect_runs("drag \"map a\" by 80 -40");
  const ViewPoint turned = ui_.explorer().settings().camera_a;
  EXPECT_NE(turned.turn_deg, before.turn_deg);
  EXPECT_LT(turned.elevation_deg, before.elevation_deg);
  expect_runs("drag \"map b\" by 80 0 right");
  EXPECT_NE(ui_.explorer().settings().camera_a.centre_m, turned.centre_m) << "linked";
  expect_runs("mouse move \"map a\"\nwheel 3");
  EXPECT_LT(ui_.explorer().settings().camera_a.height_m, turned.height_m);
}

TEST_F(Headless, ADoubleClickCentresOnThePointThereAndTheViewTurnsAboutIt) {
  expect_runs(kRoom);
  const PixelRect pane = *ui_.anchor("map a");
  const Settings before = ui_.explorer().settings();
  const PixelPoint clicked{std::round(pane.left + 0.6 * pane.width),
                           std::round(pane.top + 0.4 * pane.height)};
  expect_runs("double-click \"map a\" at 0.6 0.4");
  const ViewPoint view = ui_.explorer().settings().camera_a;
  const PixelPoint was = *projection_of(before.camera_a, false, pane)(view.centre_m);
  EXPECT_LT(std::hypot(was.x - clicked.x, was.y - clicked.y), 13) << "a point near the mouse";
  EXPECT_EQ(view.height_m, before.camera_a.height_m);
  expect_runs("drag \"map a\" at 0.2 0.2 by 60 -30");
  const ViewPoint& turned = ui_.explorer().settings().camera_a;
  const PixelPoint middle = *projection_of(turned, false, pane)(view.centre_m);
  EXPECT_NEAR(middle.x, pane.left + pane.width / 2, 1);
  EXPECT_NEAR(middle.y, pane.top + pane.height / 2, 1);
}

TEST_F(Headless, TheLightThemeHasLightPanes) {
  expect_runs(kRoom);
  const PixelRect pane = *ui_.anchor("map a");
  const auto corner = [&] {
    return ui_.screenshot().pixel(static_cast<int>(pane.left) + 4, static_cast<int>(pane.top) + 4)[1];
  };
  EXPECT_LT(corner(), 40);
  expect_runs("theme light\nwait solved");
  EXPECT_GT(corner(), 200);
  expect_runs("backdrop black\nwait solved");
  EXPECT_LT(corner(), 40);
}

TEST_F(Headless, TheSwipesDividerFollowsTheMouse) {
  expect_runs(kRoom);
  expect_runs("layout swipe\ndrag divider by 100 0");
  EXPECT_GT(ui_.explorer().settings().divider, 0.55);
}

TEST_F(Headless, APointIsAskedAndADistanceIsMeasuredByClicks) {
  expect_runs(kRoom);
  expect_runs("tool pick\nclick \"map a\" at 0.5 0.5");
  expect_runs("tool profile\ndrag \"map a\" at 0.4 0.5 to \"map a\" at 0.6 0.5");
  EXPECT_NE(ui_.explorer().settings().profile_from_m, ui_.explorer().settings().profile_to_m);
}

TEST_F(Headless, ABrokenFileDroppedOnTheWindowGivesAMessageAndTheWindowLivesOn) {
  const test::ScratchFolder folder;
  const auto path = folder / "dropped.bag";
  ASSERT_TRUE(write_file(path, "no bag"));
  expect_runs("drop " + path.string() + "\nwait loaded\nexpect message contains dropped.bag\nkey Escape");
  EXPECT_EQ(now("message"), "");
  expect_runs(kRoom);
}

TEST_F(Headless, AnAskedPointAndAMeasuredDistanceAreCommandsThatEscapeTakesBack) {
  expect_runs(kRoom);
  expect_runs("camera-a 3 0 0 60 0 90\ntool pick\nclick \"map a\"");
  EXPECT_NE(now("pick"), "-1 -1");
  expect_runs("tool measure\nclick \"map a\"\nclick \"map a\" at 0.5 0.54");
  EXPECT_NE(now("measure"), "0 0 0 0 0 0");
  expect_runs("key Escape\nexpect tool is look\nexpect pick is -1 -1\nexpect measure is 0 0 0 0 0 0");
  expect_runs("undo");
  EXPECT_NE(now("measure"), "0 0 0 0 0 0") << "one step back";
}

TEST_F(Headless, TheCopiedCommandLineMakesTheSamePicture) {
  expect_runs(kRoom);
  expect_runs("offset-a 19\noffset-b 24\nlayout swipe\ntheme light\ndrag \"map a\" by 30 20\nwait solved");
  const Image here = ui_.screenshot();
  expect_runs("copy-command");
  std::string line = ui_.clipboard();
  ASSERT_EQ(line.find("sweepscope view"), 0u) << line;
  const test::ScratchFolder folder;
  const test::Outcome copied =
      test::run_program(folder.path(), line.substr(std::string("sweepscope").size()));
  ASSERT_EQ(copied.exit_code, 0) << line << "\n" << copied.err;
  const auto there = read_png(folder / "picture.png");
  ASSERT_TRUE(there) << there.error().message;
  EXPECT_TRUE(compare_images(*there, here).passes);
}

TEST_F(Headless, TheReportIsWrittenBesideTheInterface) {
  expect_runs(kRoom);
  const test::ScratchFolder folder;
  expect_runs("export-report " + folder.path().string() + "\nexpect message contains report.html");
  const auto page = read_file(folder / "report.html");
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_NE(page->find("t_motor = t_laser + offset"), std::string::npos);
  expect_runs("frames 3");  // the interface draws on after the report's pictures were drawn
}

TEST_F(Headless, AnExportThatFailsEndsAScriptAndAnOpeningThatFailsDoesNot) {
  expect_runs("open /nowhere/at-all.bag\nwait loaded\nexpect message contains at-all.bag");
  expect_runs("open /nowhere/at-all.json\nexpect message contains at-all.json");
  expect_runs(kRoom);
  const auto done = run("export-picture /nowhere/a.png");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ExitCode::kWrongUsage);
}

TEST_F(Headless, WanderingLeavesTheInterfaceAlive) {
  const test::ScratchFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  expect_runs("wander 30 1\nsample room-1\nwait solved\nwander 60 2\ncancel\nclose\nframes 2");
  std::filesystem::current_path(before);
}

TEST_F(Headless, EveryStateHasAPictureOfItsOwn) {
  std::vector<Image> pictures;
  const auto keep = [&](const std::string& lines) {
    expect_runs(lines);
    pictures.push_back(ui_.screenshot());
  };
  keep("frames 3");
  keep("help");
  keep("dismiss\npalette");
  keep("dismiss\nask open");
  keep("dismiss\nsample room-1\nwait solved");
  keep("layout swipe\nwait solved");
  keep("layout side-by-side\nscan-view on\nwait solved");
  keep("scan-view off\npanels off\nwait solved");
  keep("panels on\nui-scale 1.5\nwait solved");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_FALSE(compare_images(pictures[i], pictures[j]).passes) << i << ", " << j;
  }
}

TEST(Chords, ReadBackAsTheyAreWritten) {
  for (const Shortcut& shortcut : shortcuts()) {
    const auto chord = parse_chord(shortcut.chord);
    ASSERT_TRUE(chord) << shortcut.chord;
    EXPECT_EQ(to_text(*chord), shortcut.chord);
  }
  for (const char* text : {"", "Ctrl+", "a", "Hyper+A", "F25"}) EXPECT_FALSE(parse_chord(text)) << text;
}

}  // namespace
}  // namespace sweepscope::ui
