// The whole story three times over, with the mouse alone, with the keyboard alone and as a script: the saved
// sessions are the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"
#include "ui/script/script.hpp"
#include "ui/state/session.hpp"

namespace sweepscope::ui {
namespace {

namespace fs = std::filesystem;

class Story : public test::FolderTest {
 protected:
  void SetUp() override {
    before_ = fs::current_path();
    fs::current_path(folder_);  // where the dialogs suggest to write
  }
  void TearDown() override { fs::current_path(before_); }

  /// Tells it in a fresh interface, with lines of these kinds alone; returns the session that it saved as
  /// room-1.session.json.
  std::string tell(const std::string& lines, const std::vector<std::string>& kinds) {
    const auto script = parse_script(lines, "story");
    EXPECT_TRUE(script) << script.error().message;
    for (const Script::Line& line : script->lines)
      EXPECT_NE(std::find(kinds.begin(), kinds.end(), line.words[0]), kinds.end()) << line.text;
    auto context = gl::make_offscreen_context(1400, 900);
    Ui ui(**context, Ui::Options());
    const auto done = run_script(ui, *script, 300);
    EXPECT_TRUE(done) << done.error().message;
    const auto session = read_file("room-1.session.json");
    EXPECT_TRUE(session) << session.error().message;
    fs::remove("room-1.session.json");
    return session.value_or("");
  }

 private:
  fs::path before_;
};

std::string numbers(const std::vector<double>& values) {
  std::string words;
  for (const double value : values) words += " " + to_word(Value(value));
  return words;
}

/// What the mouse did to these settings, as lines of commands: its places are its own.
struct PlacesOfStory {
  std::string offset_a, divider, camera, window, asked, profile;

  explicit PlacesOfStory(const Settings& s)
      : offset_a("offset-a" + numbers({s.offset_a_ms})),
        divider("divider" + numbers({s.divider})),
        camera("camera-a" +
               numbers({s.camera_a.centre_m.x(), s.camera_a.centre_m.y(), s.camera_a.centre_m.z(),
                        s.camera_a.height_m, s.camera_a.turn_deg, s.camera_a.elevation_deg})),
        window("time-window" + numbers({s.time_from_s, s.time_to_s})),
        asked("pick" + numbers({s.asked_scan, s.asked_beam})),
        profile("profile" + numbers({s.profile_from_m.x(), s.profile_from_m.y(), s.profile_to_m.x(),
                                     s.profile_to_m.y()})) {}
};

constexpr const char* kWithTheMouse = R"(
click "button sample room-1"
wait solved
click search
click "search range"
click "button estimate"
wait estimated
drag "handle a" to "chart 0" at 0.6 0.8
click "menu View"
click "menu layout swipe"
wait solved
drag divider by 90 0
drag "map a" at 0.3 0.5 to "map a" at 0.4 0.45
mouse move "map a" at 0.4 0.4
wheel 2
click colouring
click "colouring intensity"
drag time-window at 0.97 0.5 to time-window at 0.6 0.5
wait solved
click "menu Tools"
click "menu tool pick"
click "map a" at 0.15 0.8
click "menu Tools"
click "menu tool profile"
drag "map a" at 0.2 0.7 to "map a" at 0.25 0.75
click "menu Tools"
click "menu tool look"
click "menu View"
click "menu theme"
click "menu View"
click "menu layout difference"
click "menu Edit"
click "menu undo"
wait solved
click "menu File"
click "menu ask save-session"
click "button ok"
)";

/// Every line that no key stands for is typed into the palette.
std::string with_the_keyboard(const PlacesOfStory& places) {
  std::string lines;
  const auto typed = [&](const std::string& line) {
    lines += fmt::format("key Ctrl+P\ntype \"{}\"\nkey Enter\n", line);
  };
  typed("sample room-1");
  lines += "wait solved\n";
  typed("search range");
  lines += "key E\nwait estimated\n";
  typed(places.offset_a);
  lines += "key S\nwait solved\n";
  typed(places.divider);
  typed(places.camera);
  lines += "key C\n";  // elevation, intensity
  typed(places.window);
  lines += "wait solved\nkey I\n";
  typed(places.asked);
  lines += "key P\n";
  typed(places.profile);
  typed("tool look");
  lines += "key T\nkey D\nkey Ctrl+Z\nwait solved\nkey Ctrl+S\nkey Enter\n";
  return lines;
}

std::string as_a_script(const PlacesOfStory& places) {
  return fmt::format(
      "sample room-1\nwait solved\nsearch range\nestimate\nwait estimated\n{}\nlayout swipe\nwait solved\n"
      "{}\n{}\ncolouring intensity\n{}\n{}\n{}\ntheme light\nsave-session room-1.session.json\n",
      places.offset_a, places.divider, places.camera, places.window, places.asked, places.profile);
}

TEST_F(Story, TheMouseTheKeyboardAndAScriptEndInTheSameSession) {
  const std::string by_mouse = tell(kWithTheMouse, {"click", "drag", "mouse", "wheel", "wait"});
  const auto session = parse_session(by_mouse, "mouse");
  ASSERT_TRUE(session) << session.error().message;
  const Settings& s = session->settings;
  // The mouse did something at every step, or the others would have nothing to repeat.
  EXPECT_EQ(session->source, "sample room-1");
  ASSERT_TRUE(session->estimate);
  EXPECT_NE(s.offset_a_ms, 0);
  EXPECT_NEAR(s.offset_b_ms, 24, 0.3);
  EXPECT_EQ(s.layout, Layout::kSwipe);
  EXPECT_GT(s.divider, 0.5);
  EXPECT_NE(s.camera_a.turn_deg, 0);
  EXPECT_EQ(s.colouring, ColourBy::kIntensity);
  EXPECT_GT(s.time_to_s, s.time_from_s);
  EXPECT_GE(s.asked_scan, 0);
  EXPECT_NE(s.profile_from_m, s.profile_to_m);
  EXPECT_EQ(s.theme, Theme::kLight);

  const PlacesOfStory places(s);
  EXPECT_EQ(tell(with_the_keyboard(places), {"key", "type", "wait"}), by_mouse);
  std::vector<std::string> commands_alone{"wait"};
  for (const Command& command : commands()) commands_alone.push_back(command.name);
  EXPECT_EQ(tell(as_a_script(places), commands_alone), by_mouse);
}

}  // namespace
}  // namespace sweepscope::ui
