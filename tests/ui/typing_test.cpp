// What a person types, in fields and beside them, without a display.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/panes/number_box.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

/// An explorer without a display, in a folder of its own.
class Typing : public test::FolderTest {
 protected:
  void SetUp() override {
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(folder_);
  }
  void TearDown() override { std::filesystem::current_path(before_); }
  void expect_runs(const std::string& lines) {
    const auto done = run_script(ui_, *parse_script(lines, "test"), 120);
    EXPECT_TRUE(done) << done.error().message;
  }
  std::string now(const std::string& name) { return *observe(ui_.explorer(), name); }
  /// All at once, as a window reports what is typed while a frame is drawn.
  void type_fast(const std::string& text) {
    std::vector<InputEvent> events;
    for (const char letter : text) {
      const Key key = letter >= 'a' && letter <= 'z' ? letter - 'a' + 'A' : letter;
      events.push_back(InputEvent::stroke(key, true, 0));
      events.push_back(InputEvent::words(std::string(1, letter)));
      events.push_back(InputEvent::stroke(key, false, 0));
    }
    ui_.frame(events, 1.0 / 60);
  }
  void frames_until_taken() {
    do {
      ui_.frame({}, 1.0 / 60);
    } while (ui_.has_input());
  }

  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(1200, 800);
  Ui ui_{*context_, Ui::Options()};

 private:
  std::filesystem::path before_;
};

TEST_F(Typing, WhatFollowsTheKeyOfADialogInTheSameFrameArrivesWholeInItsField) {
  std::vector<InputEvent> open{InputEvent::stroke('P', true, kCtrl), InputEvent::stroke('P', false, kCtrl)};
  ui_.frame(open, 1.0 / 60);
  type_fast("theme light");
  frames_until_taken();
  expect_runs("expect theme is dark\nkey Enter\nexpect theme is light");
}

TEST_F(Typing, EnterInTheFrameOfAPalettesWordsRunsWhatTheyFind) {
  expect_runs("sample room-1\nwait solved\nexpect colouring is elevation\nkey Ctrl+P\nframes 5");
  std::vector<InputEvent> events{InputEvent::words("blur"), InputEvent::stroke(keys::kEnter, true, 0),
                                 InputEvent::stroke(keys::kEnter, false, 0)};
  ui_.frame(events, 1.0 / 60);
  frames_until_taken();
  expect_runs("expect colouring is blur");
}

TEST_F(Typing, EnterAndSpaceChooseInLists) {
  expect_runs("sample room-1\nwait solved\nclick layout\nkey Down\nkey Enter\nexpect layout is swipe");
  expect_runs("click layout\nkey Up\nkey Space\nexpect layout is side-by-side");
  expect_runs("click colouring\nkey Down\nkey Down\nkey Enter\nexpect colouring is time");
  expect_runs("key Space\nexpect layout is a");
}

TEST_F(Typing, ThePaletteKnowsValuesAndOtherWordsForThem) {
  expect_runs("sample room-1\nwait solved");
  for (const auto& [words, line] :
       {std::pair{"blur", "colouring blur"}, std::pair{"png", "ask export-figure"},
        std::pair{"reset", "fit-view"}, std::pair{"sync", "linked"}, std::pair{"top view", "look top"},
        std::pair{"cividis", "table cividis"}, std::pair{"dark mode", "theme"}}) {
    expect_runs(std::string("key Ctrl+P\ntype \"") + words + "\"\nframes 3");
    EXPECT_TRUE(ui_.anchor(std::string("palette ") + line)) << words;
    expect_runs("key Escape");
  }
  expect_runs("key Ctrl+P\ntype blur\nkey Enter\nexpect colouring is blur");
}

TEST_F(Typing, AFigureIsExportedFromItsDialogByMouse) {
  expect_runs(
      "sample room-1\noffset-b 24\nwait solved\nkey Ctrl+Shift+E\nwait solved\nclick \"figure size\"\n"
      "click \"figure size 1920x1080\"\nclick \"figure legend\"\nclick \"figure type.svg\"\nwait solved\n"
      "click \"button ok\"\nwait solved\nexpect message contains room");
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder_))
    count += file.path().extension() == ".svg" ? 1 : 0;
  EXPECT_EQ(count, 1);
}

TEST_F(Typing, ASmallWindowHasTabsForItsPanels) {
  const auto context = *gl::make_offscreen_context(390, 844);
  Ui phone(*context, Ui::Options());
  const auto runs = [&](const std::string& lines) {
    const auto done = run_script(phone, *parse_script(lines, "test"), 120);
    EXPECT_TRUE(done) << done.error().message;
  };
  runs("sample room-1\nwait solved\nclick \"button estimate\"\nwait estimated\nwait solved");
  EXPECT_GT(phone.anchor("map b")->top, phone.anchor("map a")->bottom()) << "one above the other";
  EXPECT_TRUE(phone.anchor("close-up a"));
  runs("click \"button open-panel recording\"\nframes 3");
  EXPECT_TRUE(phone.anchor("answer"));
  runs(
      "click \"button open-panel display\"\nframes 3\nclick colouring\nclick \"colouring blur\"\n"
      "expect colouring is blur\nkey Escape\nexpect open-panel is none");
}

TEST_F(Typing, LettersInAFieldAreNoShortcuts) {
  expect_runs("sample room-1\nwait solved\nclick offset-a");
  type_fast("17.5");
  frames_until_taken();
  type_fast("tbsdhe");
  frames_until_taken();
  expect_runs("expect theme is dark\nexpect layout is side-by-side\nexpect jobs is 0\nkey Escape");
  EXPECT_EQ(now("offset-a"), "0");
}

TEST_F(Typing, ASingleClickAndANumberSetAnOffset) {
  expect_runs("sample room-1\nwait solved\nclick offset-a\ntype 19.25\nkey Enter\nexpect offset-a is 19.25");
  expect_runs("undo\nexpect offset-a is 0");
  expect_runs("click offset-b\ntype \"24,5 ms\"\nkey Enter\nexpect offset-b is 24.5");
}

TEST_F(Typing, TabGoesOnToTheNextNumberAndSetsTheOneBefore) {
  expect_runs("sample room-1\nwait solved\nkey Tab\ntype 12\nkey Tab\ntype 13\nkey Enter");
  EXPECT_EQ(now("offset-a"), "12");
  EXPECT_EQ(now("offset-b"), "13");
  expect_runs("key Tab\nkey Tab\nkey Shift+Tab\ntype 14\nkey Enter\nexpect offset-a is 14");
  expect_runs("key Tab\ntype 3\nkey Escape\nexpect offset-a is 14");
}

TEST_F(Typing, ANumberThatIsNoneOrOutsideTheSearchWindowIsRefusedWithTheReason) {
  expect_runs("sample room-1\nwait solved\noffset-a 5");
  for (const char* text : {"2,4,5", "abc", "1.2.3", "\"\""}) {
    expect_runs(std::string("click offset-a\nkey Ctrl+A\ntype ") + text +
                "\nkey Enter\nexpect offset-a is 5");
    if (std::string(text) != "\"\"") expect_runs("expect message contains is not a number\ndismiss");
  }
  expect_runs("dismiss\nclick offset-a\ntype 400\nkey Enter\nexpect offset-a is 5");
  expect_runs("expect message contains outside the search window\nexpect message contains -249 to 249 ms");
  EXPECT_FALSE(ui_.explorer().perform("offset-b -251"));
  EXPECT_TRUE(ui_.explorer().perform("offset-b -249"));
  EXPECT_TRUE(ui_.explorer().perform("search range"));
  EXPECT_TRUE(ui_.explorer().perform("search-range 380 420 1"));
  EXPECT_TRUE(ui_.explorer().perform("offset-b 400"));  // who searches there may look there
}

TEST(TypedNumbers, HaveAPointOrACommaAndPerhapsTheirUnit) {
  const Parameter& offset = find_command("offset-a")->parameters[0];
  for (const auto& [text, number] : std::vector<std::pair<std::string, double>>{
           {"24.5", 24.5}, {"24,5", 24.5}, {" 24.5 ms", 24.5}, {"-3", -3}, {"+3", 3}, {"1e1ms", 10}})
    EXPECT_EQ(parse_typed_number(offset, text), number) << text;
  for (const char* text : {"", "ms", "24,5,1", "1,234.5", "24.5 s", "1e9", "nan", "24 5"})
    EXPECT_FALSE(parse_typed_number(offset, text)) << text;
}

TEST_F(Typing, ThePointOrTheOffsetIsCopiedAndTheCommandLineByItsOwnKey) {
  expect_runs("sample room-1\nwait solved\noffset-a 19.5\nkey Ctrl+C");
  EXPECT_EQ(ui_.clipboard(), "19.5");
  expect_runs("expect message contains the offset of map A\noffset-b 24\nkey Ctrl+C");
  EXPECT_EQ(ui_.clipboard(), "24");
  expect_runs("tool pick\nwait solved\nclick \"map a\"\nkey Ctrl+C");
  if (now("pick") != "-1 -1") {
    EXPECT_EQ(std::count(ui_.clipboard().begin(), ui_.clipboard().end(), ' '), 2) << ui_.clipboard();
  }
  expect_runs("key Ctrl+Shift+C");
  EXPECT_EQ(ui_.clipboard().find("sweepscope view"), 0u);
}

TEST_F(Typing, TheKeysAreListedByF1AndByAQuestionMark) {
  const Image before = (expect_runs("frames 3"), ui_.screenshot());
  for (const char* line : {"key F1", "key ?", "type ?"}) {
    expect_runs(line);
    EXPECT_NE(ui_.screenshot(), before) << line;
    expect_runs("key Escape");
    EXPECT_EQ(ui_.screenshot(), before) << line;
  }
  for (const char* line : {"key F1", "key H", "key ?"}) {
    expect_runs(std::string(line) + "\n" + line);
    EXPECT_EQ(ui_.screenshot(), before) << line << " closes what it opened";
  }
}

TEST_F(Typing, MenusWorkByKeyboard) {
  expect_runs("sample room-1\nwait solved\nkey F10\nkey Escape\nkey T\nexpect theme is light");
  // Two menus to the right of File is Offset. Its first entry has the focus, its second one makes no sense
  // yet and is passed over, and its third one swaps the offsets.
  expect_runs(
      "offset-a 3\noffset-b 4\nkey F10\nkey Right\nframes 2\nkey Right\nframes 2\nkey Down\nkey Enter");
  if (now("offset-a") != "4") expect_runs("key Escape");
  EXPECT_EQ(now("offset-a"), "4");
  EXPECT_EQ(now("offset-b"), "3");
}

TEST_F(Typing, TheStartPageWorksByKeyboard) {
  expect_runs("key Down\nkey Down\nkey Enter\nwait loaded\nexpect recording is room-1");
}

TEST_F(Typing, AFileIsReplacedOnlyWhenThatIsConfirmed) {
  const auto file = std::filesystem::current_path() / "criteria.csv";
  expect_runs("sample room-1\nwait solved\nestimate\nwait estimated");
  ASSERT_TRUE(write_file(file, "mine"));
  expect_runs("ask export-curve\nkey Ctrl+A\ntype criteria.csv\nkey Enter");
  EXPECT_EQ(*read_file(file), "mine");
  expect_runs("key Escape\nframes 3");
  EXPECT_EQ(*read_file(file), "mine");
  expect_runs("ask export-curve\nkey Ctrl+A\ntype criteria.csv\nkey Enter\nkey Enter");
  EXPECT_NE(*read_file(file), "mine");
  expect_runs("expect message contains " + file.string());
  ASSERT_TRUE(write_file(file, "mine"));
  expect_runs("key Ctrl+P\ntype \"export-curve criteria.csv\"\nkey Enter");
  EXPECT_EQ(*read_file(file), "mine");
  expect_runs("key Enter");
  EXPECT_NE(*read_file(file), "mine");
}

TEST_F(Typing, AMessageGoesByItselfAndCoversNothing) {
  expect_runs("sample room-1\nwait solved\nkey Ctrl+C\nframes 2");
  ASSERT_NE(now("message"), "");
  const PixelRect message = *ui_.anchor("message");
  for (const char* name : {"map a", "map b", "chart 0", "button estimate"}) {
    const PixelRect other = *ui_.anchor(name);
    EXPECT_LE(other.bottom(), message.top) << name;
  }
  const PixelRect map = *ui_.anchor("map a");
  expect_runs("frames 500");
  EXPECT_EQ(now("message"), "");
  EXPECT_EQ(ui_.anchor("map a")->height, map.height);  // the charts made room for it
}

}  // namespace
}  // namespace sweepscope::ui
