#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "ui/commands/commands.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/state/history.hpp"
#include "ui/state/session.hpp"

namespace sweepscope::ui {
namespace {

Settings after(const std::string& line, const Settings& settings = {}) {
  const auto call = parse_call(line);
  EXPECT_TRUE(call) << line;
  return call ? changed(settings, *call) : settings;
}

/// Every setting away from its default.
Settings unusual() {
  Settings s;
  for (const Command& command : commands()) {
    if (!command.is_field()) continue;
    std::string line = command.name;
    for (const Parameter& p : command.parameters) {
      const double middle = p.least + (std::min(p.greatest, p.least + 4) - p.least) * 0.625;
      line += p.kind == Kind::kNumber   ? " " + to_word(Value(middle))
              : p.kind == Kind::kChoice ? " " + p.choices.back()
                                        : "";
    }
    s = after(line, s);
  }
  return s;
}

TEST(Commands, AreNamedOnceAndSayWhatTheyAreFor) {
  std::set<std::string> names;
  for (const Command& command : commands()) {
    EXPECT_TRUE(names.insert(command.name).second) << command.name;
    EXPECT_FALSE(command.title.empty()) << command.name;
    EXPECT_TRUE(command.help.ends_with(".")) << command.name;
  }
}

TEST(Commands, HaveExactlyOneHandlerEach) {
  for (const Command& command : commands()) {
    const auto* field = std::get_if<Field>(&command.handler);
    const auto* edit = std::get_if<Edit>(&command.handler);
    const auto* action = std::get_if<Action>(&command.handler);
    const auto* in_window = std::get_if<WindowAction>(&command.handler);
    const int handlers = (field && field->get && field->set ? 1 : 0) + (edit && edit->set ? 1 : 0) +
                         (action && action->run ? 1 : 0) + (in_window && in_window->run ? 1 : 0);
    EXPECT_EQ(handlers, 1) << command.name;
    EXPECT_EQ(find_command(command.name), &command);
  }
}

TEST(Commands, ANameThatIsUnknownCannotSucceed) {
  Explorer explorer;
  const Command unknown{"dance", "Dance", "Not in the table.", {}, WindowAction{}};
  for (const auto& done : {explorer.perform("dance"), explorer.perform(Call{find_command("dance"), {}}),
                           explorer.perform(Call{&unknown, {}})}) {
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ExitCode::kWrongUsage);
    EXPECT_FALSE(done.error().message.empty());
  }
}

TEST(Commands, OfAWindowSayThatTheyNeedOne) {
  Explorer explorer;
  for (const Command& command : commands()) {
    if (!std::holds_alternative<WindowAction>(command.handler) || !command.parameters.empty()) continue;
    const auto done = explorer.perform(command.name);
    ASSERT_FALSE(done) << command.name;
    EXPECT_EQ(done.error().message, "\"" + command.name + "\" needs a window");
  }
}

TEST(Commands, ThatNameAFileSayHowTheyUseIt) {
  const auto asked = find_command("ask")->parameters[0].choices;
  for (const Command& command : commands()) {
    const bool names_file = std::ranges::any_of(command.parameters, [](const Parameter& p) {
      return p.name == "FILE" || p.name == "FOLDER" || p.name == "POSES";
    });
    for (const Parameter& p : command.parameters)
      EXPECT_EQ(p.name == "FILE" || p.name == "FOLDER" || p.name == "POSES", p.file != FileUse::kNone)
          << command.name;
    EXPECT_EQ(std::ranges::count(asked, command.name), names_file ? 1 : 0) << command.name;
  }
}

TEST(Commands, EveryKeyAndMenuEntryIsALineThatParses) {
  std::set<std::string> chords;
  for (const Shortcut& shortcut : shortcuts()) {
    EXPECT_TRUE(parse_call(shortcut.line)) << shortcut.line;
    EXPECT_TRUE(chords.insert(shortcut.chord).second) << shortcut.chord;
  }
  for (const MenuItem& item : menu_items()) {
    if (!item.line.empty()) {
      EXPECT_TRUE(parse_call(item.line)) << item.line;
    }
  }
}

TEST(Commands, EverySettingHasAFieldCommandThatChangesIt) {
  const Settings unusual_settings = unusual();
  for (const Command& command : commands()) {
    if (!command.is_field()) continue;
    EXPECT_NE(command.get(unusual_settings), command.get(Settings())) << command.name;
  }
}

TEST(Commands, LinesToReachRebuildTheSettings) {
  Settings rebuilt;
  for (const std::string& line : lines_to_reach(unusual())) rebuilt = after(line, rebuilt);
  EXPECT_EQ(rebuilt, unusual());
  EXPECT_TRUE(lines_to_reach(Settings()).empty());
}

TEST(Commands, ALineThatDoesNotFitSaysWhatWould) {
  for (const auto& [line, words] : std::vector<std::pair<std::string, std::string>>{
           {"sideways", "no command \"sideways\""},
           {"offset-a", "offset-a OFFSET"},
           {"offset-a 19 20", "offset-a OFFSET"},
           {"offset-a nineteen", "not \"nineteen\""},
           {"offset-a nan", "not \"nan\""},
           {"layout upside-down", "side-by-side, swipe, a, b, difference or stacked"},
           {"point-size 99", "1 to 8 px"},
           {"open \"unclosed", "quote"}}) {
    const auto call = parse_call(line);
    ASSERT_FALSE(call) << line;
    EXPECT_EQ(call.error().code, ExitCode::kWrongUsage);
    EXPECT_NE(call.error().message.find(words), std::string::npos) << call.error().message;
  }
}

TEST(Commands, WithoutArgumentASwitchTurnsOverAndAChoiceMovesOnAndComesRound) {
  EXPECT_FALSE(after("linked").linked);
  EXPECT_TRUE(after("linked", after("linked")).linked);
  Settings s;
  for (int i = 0; i < 4; ++i) s = after("table", s);
  EXPECT_EQ(s.table, Settings().table);
  EXPECT_EQ(after("table").table, "cividis");
}

TEST(Commands, NudgesAddUpWithoutRoundingErrors) {
  Settings s;
  for (int i = 0; i < 240; ++i) s = after("nudge a 0.1", s);
  EXPECT_EQ(s.offset_a_ms, 24);
  EXPECT_EQ(s.offset_b_ms, 0);
}

TEST(Commands, ANameWithSpacesSurvivesTheLine) {
  const auto call = parse_call("open \"a b # c.bag\"");
  ASSERT_TRUE(call);
  EXPECT_EQ(call->text(0), "a b # c.bag");
  EXPECT_EQ(to_line(*call), "open \"a b # c.bag\"");
}

TEST(History, UndoAndRedoAreOpposites) {
  History history;
  Settings first, second = after("offset-a 19"), third = after("theme light", second);
  history.record(first, "");
  history.record(second, "");
  EXPECT_EQ(history.undo(third), second);
  EXPECT_EQ(history.undo(second), first);
  EXPECT_FALSE(history.can_undo());
  EXPECT_EQ(history.redo(first), second);
  EXPECT_EQ(history.redo(second), third);
  EXPECT_FALSE(history.can_redo());
}

TEST(History, ADragIsOneStep) {
  History history;
  for (int i = 0; i < 50; ++i) history.record(after("offset-a " + std::to_string(i)), "drag 1");
  history.record(after("offset-a 50"), "drag 2");
  EXPECT_EQ(history.undo(after("offset-a 60")).offset_a_ms, 50);
  EXPECT_EQ(history.undo(after("offset-a 50")).offset_a_ms, 0);
  EXPECT_FALSE(history.can_undo());
}

TEST(Session, ComesBackAsItWas) {
  Session session{"sample room-1", {}, unusual(), {}};
  Estimate estimate;
  estimate.recording = "room-1";
  estimate.method = Method::kStationary;
  estimate.identifiable = true;
  estimate.offset_s = 0.0240123;
  estimate.curve.emplace_back().offset_s = 0.024;
  estimate.curve.back().d = 0.004;
  session.estimate = estimate;
  const auto back = parse_session(session_to_json(session), "a.json");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->settings, session.settings);
  EXPECT_EQ(back->source, session.source);
  ASSERT_TRUE(back->estimate);
  EXPECT_NEAR(*back->estimate->offset_s, 0.0240123, 1e-12);
  EXPECT_EQ(session_to_json(*back), session_to_json(session));
}

TEST(Session, MissingKeysKeepDefaultsAndUnknownOnesArePassedOver) {
  const auto session = parse_session(
      R"({"schema": "sweepscope.session/1", "settings": {"offset-a": 19, "later": [1, 2]}, "x": 0})",
      "a.json");
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(session->settings, after("offset-a 19"));
}

TEST(Session, WhatIsNoSessionIsRefusedWithItsNameAndPlace) {
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"", "no JSON object"},
           {"[1]", "no JSON object"},
           {R"({"schema": "sweepscope.session/9"})", "sweepscope.session/1"},
           {R"({"schema": "sweepscope.session/1", "settings": {"theme": "pink"}})", "settings.theme"},
           {R"({"schema": "sweepscope.session/1", "settings": {"slab": [1]}})", "settings.slab"},
           {R"({"schema": "sweepscope.session/1", "settings": 7})", "settings"}}) {
    const auto session = parse_session(text, "a.json");
    ASSERT_FALSE(session) << text;
    EXPECT_EQ(session.error().code, ExitCode::kUnreadableInput);
    EXPECT_EQ(session.error().message.find("a.json"), 0u) << session.error().message;
    EXPECT_NE(session.error().message.find(words), std::string::npos) << session.error().message;
  }
}

}  // namespace
}  // namespace sweepscope::ui
