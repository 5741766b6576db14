// What a window offers where something is wrong.
#include "ui/explorer/hints.hpp"

#include <gtest/gtest.h>
#include <imgui.h>

#include "core/io/atomic_file.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/commands/commands.hpp"
#include "ui/panes/widgets.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

using test::InARoom, test::perform, test::rest, test::scratch;

Estimate refused(RefusalKind kind) {
  Estimate estimate;
  estimate.refusals.push_back({kind, {}, {}, entry_of(kind).text});
  return estimate;
}

std::vector<std::string> lines_for(const Explorer& explorer, const Estimate& estimate) {
  std::vector<std::string> lines;
  for (const Hint& hint : hints_for(explorer, estimate)) lines.push_back(hint.line);
  return lines;
}

using Lines = std::vector<std::string>;

TEST_F(InARoom, ARefusalOffersWhatHelps) {
  EXPECT_EQ(lines_for(explorer_, refused(RefusalKind::kClocksDrift)), Lines{"estimate over-time"});
  EXPECT_EQ(lines_for(explorer_, refused(RefusalKind::kOneWayAtOneSpeed)), Lines{"estimate mount"});
  EXPECT_EQ(lines_for(explorer_, refused(RefusalKind::kScanLinesDoNotRepeat)), Lines{"estimate stationary"});
  EXPECT_EQ(lines_for(explorer_, refused(RefusalKind::kSigmaTooLarge)), Lines{});
  EXPECT_EQ(lines_for(explorer_, refused(RefusalKind::kMotorGaps)), Lines{}) << "a sample has no other motor";
}

TEST_F(InARoom, TheMountThatWasFoundIsNotOfferedToBeSolvedForAgain) {
  perform(explorer_, "estimate mount");
  rest(explorer_);
  ASSERT_TRUE(explorer_.estimating.found()->rig);
  EXPECT_EQ(lines_for(explorer_, refused(RefusalKind::kOneWayAtOneSpeed)), Lines{});
}

TEST_F(InARoom, AWarningOffersWhatItNames) {
  Estimate estimate;
  estimate.warnings = {"Surfaces are flatter with another mount. Solve for the mount (--solve offset,mount).",
                       "The mount (--solve offset,mount)."};
  EXPECT_EQ(lines_for(explorer_, estimate), Lines{"estimate mount"}) << "once";
}

TEST_F(InARoom, AHintSetsTheSearchAndEstimates) {
  perform(explorer_, "search range");
  perform(explorer_, "estimate direct");
  EXPECT_EQ(explorer_.settings().method, "direct");
  EXPECT_EQ(explorer_.settings().search, Search::kAutomatic);
  EXPECT_TRUE(explorer_.estimating.is_running());
  perform(explorer_, "cancel");
}

TEST_F(InARoom, AMapWithoutPointsSaysWhyAndOffersToShowMore) {
  EXPECT_EQ(empty_pane(explorer_, explorer_.pane(Side::kA)).why, "");
  perform(explorer_, "heights slab");
  perform(explorer_, "slab 40 45");
  rest(explorer_);
  const EmptyPane empty = empty_pane(explorer_, explorer_.pane(Side::kA));
  EXPECT_NE(empty.why, "");
  ASSERT_EQ(empty.hints.size(), 1U);
  perform(explorer_, empty.hints[0].line);
  rest(explorer_);
  EXPECT_EQ(empty_pane(explorer_, explorer_.pane(Side::kA)).why, "");
}

TEST(Hints, AreCommandsAndWordsOfTheEngineNameNoOptions) {
  const Explorer explorer;
  for (const RefusalEntry& entry : refusal_entries()) {
    for (const Hint& hint : hints_for(explorer, refused(entry.kind)))
      EXPECT_TRUE(parse_call(hint.line)) << hint.line;
    EXPECT_EQ(without_options(entry.text).find("--"), std::string::npos) << entry.text;
  }
  EXPECT_EQ(sentence("the stamps run 2 times as fast +- 1; consider --stamps receive"),
            "The stamps run 2 times as fast ± 1.");
  EXPECT_EQ(sentence("tilt turns in base about [0, 1, 0]"), "Tilt turns in base about y.");
  EXPECT_EQ(sentence("kitchen.bag: the rig moved"), "kitchen.bag: the rig moved.");
}

/// An explorer without a display.
class Pages : public testing::Test {
 protected:
  void run(const std::string& lines) {
    const auto script = parse_script(lines, "test", false);
    ASSERT_TRUE(script);
    const auto done = run_script(ui_, *script, 120);
    EXPECT_TRUE(done) << done.error().message;
  }
  const std::string two_lasers_ = std::string(SWEEPSCOPE_SOURCE_DIR) + "/tests/screenshots/data/two-lasers";
  std::unique_ptr<gl::Context> context_ = std::move(*gl::make_offscreen_context(1200, 800));
  Ui ui_{*context_, Ui::Options()};
};

TEST_F(Pages, ThePageOfChoicesKeepsThemOnEscape) {
  run("choose " + two_lasers_ + "\nwait loaded\nchoose-laser /front/scan\nwait loaded\nkey Escape\n" +
      "expect page is start\nchoose " + two_lasers_ + "\nwait loaded\nexpect chosen-laser is /front/scan\n");
}

TEST_F(Pages, ARecordingThatIsOpenedAgainHasTheChoicesThatEscapeLeft) {
  run("open " + two_lasers_ + "\nwait loaded\nchoose-laser /front/scan\nwait loaded\nkey Escape\nopen " +
      two_lasers_ + "/\nwait loaded\nexpect page is choices\nexpect chosen-laser is /front/scan\n");
}

TEST_F(Pages, NothingOnThePageOfChoicesMovesWhenOneIsMade) {
  run("choose " + two_lasers_ + "\nwait loaded\n");
  const PixelRect before = *ui_.anchor("choose-motor"), below = *ui_.anchor("choose-stamps");
  run("choose-laser /front/scan\nwait loaded\n");
  EXPECT_EQ(ui_.anchor("choose-motor")->top, before.top);
  EXPECT_EQ(ui_.anchor("choose-stamps")->top, below.top);
}

TEST_F(Pages, TheLikeliestMotorComesFirst) {
  run("choose " + two_lasers_ + "\nwait loaded\nclick choose-motor\n");
  const auto motor = ui_.anchor("choose-motor roll_motor /joint_states");
  ASSERT_TRUE(motor);
  for (const std::string& name : ui_.anchor_names()) {
    if (name.starts_with("choose-motor ")) {
      EXPECT_GE(ui_.anchor(name)->top, motor->top) << name;
    }
  }
}

TEST_F(Pages, ALineEndsBeforeNoUnitAndWithinNoNumber) {
  run("frames 1");
  const float width_px = ImGui::CalcTextSize("Walls are 32 m").x;
  EXPECT_EQ(in_lines("Walls are 32 mm thick, 90 % under 4.5 m.", width_px),
            "Walls are\n32 mm thick,\n90 % under\n4.5 m.");
  EXPECT_EQ(in_lines("short", width_px), "short");
}

TEST(Answers, DoNotMoveWhenTheWallsAreMeasured) {
  const auto context = std::move(*gl::make_offscreen_context(1200, 800));
  Ui::Options options;
  options.explorer.estimates_on_opening = true;
  Ui ui(*context, options);
  const auto run = [&](const std::string& lines) {
    const auto done = run_script(ui, *parse_script(lines, "test", false), 120);
    EXPECT_TRUE(done) << done.error().message;
  };
  run("sample room-1\nwait estimated");
  ui.frame({}, 1.0 / 60);
  const auto before = ui.anchor("answer direct");
  run("wait solved\nexpect walls contains as recorded");
  ui.frame({}, 1.0 / 60);
  const auto after = ui.anchor("answer direct");
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->top, after->top);
}

TEST(Answers, WhatHelpsIsInSightHoweverMuchThereIsToWarnOf) {
  const auto context = std::move(*gl::make_offscreen_context(1400, 900));
  Ui ui(*context, Ui::Options());
  const auto run = [&](const std::string& lines) {
    const auto done = run_script(ui, *parse_script(lines, "test", false), 120);
    EXPECT_TRUE(done) << done.error().message;
  };
  run("sample room-1 2\nestimate\nwait solved");
  Estimate warned = *ui.explorer().estimating.found();
  const std::string much =
      ", and what follows from it takes some lines of the panel, since it says what it means for the answer";
  warned.warnings = {
      "Surfaces are flatter with another mount" + much + ". Solve for the mount (--solve offset,mount).",
      "The offset changes" + much + ". Look at it over time (--over-time).",
      "The encoder has an error" + much + ". Solve for it (--solve offset,encoder).",
      "Receive times are smoother" + much + "."};
  ui.explorer().estimating.set(warned);
  run("frames 3");
  for (const char* name : {"button estimate mount", "button estimate over-time", "button estimate encoder"}) {
    const auto button = ui.anchor(name);
    ASSERT_TRUE(button) << name;
    EXPECT_LE(button->bottom(), 900 - 28) << name << ": above the status line";
  }
}

TEST_F(Pages, APictureOfTheMapsShowsNothingThatOnlyHandsNeed) {
  const std::string a = scratch("a.png").string(), b = scratch("b.png").string();
  run("sample room-1 2\nwait solved\nhover \"link a\"\nexport-picture " + a +
      " maps\nmouse move 5 795\nframes 60\nexport-picture " + b + " maps\n");
  EXPECT_EQ(read_file(a).value(), read_file(b).value()) << "no tooltip, and no button under the mouse";
}

TEST_F(Pages, AFileIsOfTheTypeThatItsNameSays) {
  const std::string jpeg = scratch("a.jpg").string();
  run("sample room-1 2\nwait solved\nexport-picture " + jpeg + "\n");
  EXPECT_EQ(read_file(jpeg).value().substr(0, 3), "\xFF\xD8\xFF");
  for (const char* line : {"save-session a.png", "export-picture a.pcd", "export-rig a.json"}) {
    const auto done = ui_.explorer().perform(line);
    ASSERT_FALSE(done) << line;
    EXPECT_NE(done.error().message.find("is not written as"), std::string::npos) << done.error().message;
  }
}

}  // namespace
}  // namespace sweepscope::ui
