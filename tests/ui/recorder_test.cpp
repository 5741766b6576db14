#include "ui/script/recorder.hpp"

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

using RecorderTest = test::FolderTest;

std::string recorded(const std::filesystem::path& file) {
  return read_file(file).value();
}

TEST(RecordedLine, SaysWhatAPersonDid) {
  EXPECT_EQ(script_line(InputEvent::move(380, 300.5)), "mouse move 380 300.5");
  EXPECT_EQ(script_line(InputEvent::press(0, true)), "mouse down left");
  EXPECT_EQ(script_line(InputEvent::press(2, false)), "mouse up middle");
  EXPECT_EQ(script_line(InputEvent::scroll(-2)), "wheel -2");
  EXPECT_EQ(script_line(InputEvent::stroke('Z', true, kCtrl | kShift)), "key Ctrl+Shift+Z");
  EXPECT_EQ(script_line(InputEvent::words("a")), "type a");
  EXPECT_EQ(script_line(InputEvent::drop("a walk.bag")), "drop \"a walk.bag\"");
}

TEST(RecordedLine, LeavesOutReleasesAndKeysThatScriptsDoNotKnow) {
  constexpr Key kLeftShift = 340;
  EXPECT_EQ(script_line(InputEvent::stroke('Z', false, 0)), "");
  EXPECT_EQ(script_line(InputEvent::stroke(kLeftShift, true, kShift)), "");
  EXPECT_EQ(script_line(InputEvent::press(7, true)), "");
}

TEST(RecordedLine, SaysWhereAKeyWasHeld) {
  EXPECT_EQ(script_line(InputEvent::press(0, true, kShift)), "mouse down left  # with a key held");
}

TEST_F(RecorderTest, WaitsWhereThePersonHadTo) {
  const auto file = folder_ / "done.script";
  auto recorder = ScriptRecorder::create(file);
  ASSERT_TRUE(recorder);
  recorder->add_frame({}, true);
  recorder->add_frame(std::vector{InputEvent::stroke('T', true, 0), InputEvent::words("t")}, false);
  recorder->add_frame({}, false);
  EXPECT_EQ(recorded(file), "key T\ntype t\n") << "each frame's lines are there at once";
  recorder->add_frame({}, true);
  recorder->add_frame(std::vector{InputEvent::move(1, 2)}, true);
  recorder->add_frame(std::vector{InputEvent::stroke('G', true, 0)}, true, true);  // done at once
  EXPECT_TRUE(recorder->end());
  EXPECT_EQ(recorded(file), "key T\ntype t\nwait solved\nmouse move 1 2\nkey G\nwait solved\n");
  EXPECT_EQ(parse_script(recorded(file), "done.script").value().lines.size(), 6u);
}

TEST_F(RecorderTest, AScriptIsWrittenWithItsPlacesInPixelsAndDoesTheSameOnceMore) {
  const auto file = folder_ / "pixels.script";
  const auto told = [](const std::string& lines, ScriptRecorder* recorder) {
    const auto context = gl::make_offscreen_context(1200, 800);
    Ui ui(**context, Ui::Options());
    const auto done = run_script(ui, parse_script(lines, "test").value(), 120, recorder);
    EXPECT_TRUE(done) << done.error().message;
    return session_to_json(session_of(ui.explorer()));
  };
  auto recorder = ScriptRecorder::create(file);
  ASSERT_TRUE(recorder);
  const std::string session = told(
      "sample room-1\noffset-a 19\nwait solved\ndrag \"map a\" by 40 -20\nkey S\nwheel 2\n"
      "expect layout is swipe\n",
      &*recorder);
  const std::string lines = recorded(file);
  EXPECT_EQ(lines.find("sample room-1\noffset-a 19\nwait solved\nmouse move "), 0u) << lines;
  EXPECT_EQ(lines.find("map a"), std::string::npos) << lines;
  EXPECT_NE(lines.find("mouse up left\nkey S\nwheel 2\nexpect layout is swipe\n"), std::string::npos)
      << lines;
  EXPECT_EQ(told(lines, nullptr), session);
}

TEST_F(RecorderTest, SaysWhyItCannotWrite) {
  const auto recorder = ScriptRecorder::create(folder_ / "no/such.script");
  ASSERT_FALSE(recorder);
  EXPECT_EQ(recorder.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(recorder.error().message.find("no/such.script: No such file"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope::ui
