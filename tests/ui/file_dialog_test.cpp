// The dialog that opens a recording: what a folder holds, completion, and the keyboard.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/io/atomic_file.hpp"
#include "tests/folder_test.hpp"
#include "ui/model/file_list.hpp"
#include "ui/panes/fronts/file_dialog.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_of(const std::vector<FileEntry>& entries) {
  std::vector<std::string> names;
  for (const FileEntry& entry : entries) names.push_back(entry.name);
  return names;
}

class Files : public test::FolderTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_file(folder_ / "walk.bag", "#ROSBAG V2.0\n"));
    ASSERT_TRUE(write_file(folder_ / "walk-2", "\x89MCAP0\r\n"));
    ASSERT_TRUE(write_file(folder_ / "notes.txt", "walk"));
    ASSERT_TRUE(write_file(folder_ / ".hidden.bag", "#ROSBAG V2.0\n"));
    fs::create_directories(folder_ / "Walks/inner");
    fs::create_directories(folder_ / "tables");
    ASSERT_TRUE(write_file(folder_ / "tables/scans.csv", "stamp_s\n"));
  }
};

TEST_F(Files, AreFoldersFirstAndWhatOpensIsToldByItsContent) {
  const auto entries = list_folder(folder_);
  EXPECT_EQ(names_of(entries),
            (std::vector<std::string>{"Walks", "tables", "notes.txt", "walk-2", "walk.bag"}));
  std::vector<bool> opens;
  for (const FileEntry& entry : entries) opens.push_back(entry.opens);
  EXPECT_EQ(opens, (std::vector<bool>{false, true, false, true, true}));
  EXPECT_EQ(entries[4].bytes, 13u);
  EXPECT_TRUE(list_folder(folder_ / "nowhere").empty());
  EXPECT_TRUE(list_folder(folder_ / "notes.txt").empty());
}

TEST_F(Files, OfJsonOpenSessionsAndEstimates) {
  const auto folder = folder_ / "results";
  fs::create_directories(folder);
  for (const char* what : {"campaign", "estimate", "session"})
    ASSERT_TRUE(write_file(folder / (std::string(what) + ".json"),
                           "{\n  \"schema\": \"sweepscope." + std::string(what) + "/1\"}\n"));
  EXPECT_EQ(names_of(matching(list_folder(folder), "", false)),
            (std::vector<std::string>{"estimate.json", "session.json"}));
}

TEST_F(Files, AreFilteredByWhatIsTypedInAnyCaseAndByWhatOpens) {
  const auto entries = list_folder(folder_);
  EXPECT_EQ(names_of(matching(entries, "", false)),
            (std::vector<std::string>{"Walks", "tables", "walk-2", "walk.bag"}));
  EXPECT_EQ(names_of(matching(entries, "WALK", false)),
            (std::vector<std::string>{"Walks", "walk-2", "walk.bag"}));
  EXPECT_EQ(names_of(matching(entries, "n", true)), std::vector<std::string>{"notes.txt"});
}

TEST_F(Files, APathIsCompletedAsFarAsAllAgree) {
  const auto entries = list_folder(folder_);
  const auto complete = [&](const std::string& typed) {
    return completed(typed, matching(entries, split_typed(typed).name, false));
  };
  EXPECT_EQ(complete("a/walk-"), "a/walk-2");
  EXPECT_EQ(complete("tab"), "tables/");
  EXPECT_EQ(complete("/x/wal"), "/x/wal") << "Walks and walk-2 agree in no letter";
  EXPECT_EQ(complete("none"), "none");
}

TEST(TypedPaths, HaveAFolderANameAndAHome) {
  EXPECT_EQ(split_typed("/a/b").folder, "/a/");
  EXPECT_EQ(split_typed("/a/b").name, "b");
  EXPECT_EQ(split_typed("b").folder, "");
  EXPECT_EQ(without_tilde("~/a", "/home/me"), "/home/me/a");
  EXPECT_EQ(without_tilde("~", "/home/me"), "/home/me");
  EXPECT_EQ(without_tilde("a/~/b", "/home/me"), "a/~/b");
  EXPECT_EQ(without_tilde("~/a", ""), "~/a");
  EXPECT_EQ(first_path({"/data/walks/one.bag", "/other/two.bag"}), "/data/walks/");
  EXPECT_EQ(size_in_words(24100000), "24.1 MB");
}

class OpenDialog : public test::FolderTest {
 protected:
  void SetUp() override {
    before_ = fs::current_path();
    fs::current_path(folder_);
    fs::create_directories("walks/inner");
    run("sample room-1 2\nwait loaded\nsave-session walks/room.json\nclose");
    ASSERT_TRUE(fs::exists("walks/room.json"));
  }
  void TearDown() override { fs::current_path(before_); }
  void run(const std::string& lines) {
    const auto done = run_script(ui_, *parse_script(lines, "test"), 300);
    ASSERT_TRUE(done) << done.error().message;
  }

  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(1024, 768);
  Ui ui_{*context_, Ui::Options()};

 private:
  fs::path before_;
};

TEST_F(OpenDialog, OpensByTheKeyboardAlone) {
  run("key Ctrl+O\ntype wa\nkey Tab\nkey Down\nkey Down\nkey Enter\nwait loaded\nexpect recording is room-1");
  EXPECT_FALSE(ui_.anchor("ask file"));
}

TEST_F(OpenDialog, EnterGoesIntoFoldersAndOpensAPathThatWasTyped) {
  run("key Ctrl+O\ntype walks\nkey Enter");
  EXPECT_TRUE(ui_.anchor("file room.json"));
  EXPECT_TRUE(ui_.anchor("file inner"));
  run("type room.json\nkey Enter\nwait loaded\nexpect recording is room-1");
}

TEST_F(OpenDialog, OpensByTheMouse) {
  run("key Ctrl+O\nclick \"file walks\"\nframes 3\nclick \"file inner\"\nframes 3\nclick \"file ..\"\nframes 3");
  run("double-click \"file room.json\"\nwait loaded\nexpect recording is room-1");
}

TEST_F(OpenDialog, KnowsTheHomeFolder) {
  const char* home = std::getenv("HOME");
  const std::string kept = home != nullptr ? home : "";
  setenv("HOME", fs::current_path().c_str(), 1);
  run("key Ctrl+O\ntype ~/walks/ro\nkey Tab\nkey Enter\nwait loaded\nexpect recording is room-1");
  setenv("HOME", kept.c_str(), 1);
}

TEST_F(OpenDialog, EscapeClosesItAndAFileThatIsNoneGivesAMessage) {
  run("key Ctrl+O\ntype nowhere.bag\nkey Enter\nwait loaded\nexpect message contains nowhere.bag\nkey Ctrl+O\nkey Escape");
  EXPECT_FALSE(ui_.anchor("ask file"));
}

}  // namespace
}  // namespace sweepscope::ui
