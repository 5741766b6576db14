// Nothing outside of the folders that viewers are given is read or written, whatever they send.
#include "ui/model/file_roots.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/folder_test.hpp"
#include "ui/commands/commands.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/explorer/observables.hpp"

namespace sweepscope::ui {
namespace {

namespace fs = std::filesystem;

class Roots : public test::FolderTest {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "in/sub");
    fs::create_directories(folder_ / "inside-not");
    fs::create_directories(folder_ / "out");
    std::ofstream(folder_ / "out/secret.bag") << "#ROSBAG V2.0\n";
    std::ofstream(folder_ / "in/own.bag") << "#ROSBAG V2.0\n";
    fs::create_symlink(folder_ / "out/secret.bag", folder_ / "in/link.bag");
    fs::create_symlink(folder_ / "out", folder_ / "in/way-out");
    fs::create_symlink(folder_ / "out/new.json", folder_ / "in/dangling.json");
    fs::create_symlink("own.bag", folder_ / "in/good.bag");
    const fs::path root = folder_ / "in";
    roots_ = FileRoots::of({&root, 1}).value();
  }

  std::vector<fs::path> outside() const {
    return {folder_ / "out/secret.bag",
            folder_ / "in/../out/secret.bag",
            folder_ / "in/link.bag",
            folder_ / "in/way-out/secret.bag",
            folder_ / "in/way-out/new.json",
            folder_ / "in/dangling.json",
            folder_ / "inside-not/x",
            folder_ / "in/none/../../out/x",
            "/etc/passwd",
            fs::path("/proc/self/root") / "etc/passwd",
            "",
            "/",
            "../../../etc/passwd"};
  }

  Explorer::Options confined() const {
    Explorer::Options options;
    options.roots = roots_;
    return options;
  }

  FileRoots roots_;
};

TEST_F(Roots, WhatLiesBelowIsAllowed) {
  for (const char* name :
       {"in", "in/own.bag", "in/sub/new.pcd", "in/good.bag", "in/./sub/../own.bag", "in/none/new.pcd"}) {
    EXPECT_TRUE(roots_.check_read(folder_ / name)) << name;
    EXPECT_TRUE(roots_.check_write(folder_ / name)) << name;
  }
}

TEST_F(Roots, WhatLiesElsewhereIsNotWhateverItsName) {
  for (const fs::path& path : outside()) {
    EXPECT_FALSE(roots_.check_read(path)) << path;
    EXPECT_FALSE(roots_.check_write(path)) << path;
  }
}

TEST_F(Roots, TheRefusalDoesNotTellWhetherAFileExists) {
  const std::string there = roots_.check_read(folder_ / "out/secret.bag").error().message;
  std::string none = roots_.check_read(folder_ / "out/absent.bag").error().message;
  none.replace(none.find("absent"), 6, "secret");
  EXPECT_EQ(there, none);
}

TEST_F(Roots, WhatTheOwnerNamedIsReadAndNotWritten) {
  roots_.allow_reading(folder_ / "out/secret.bag");
  EXPECT_TRUE(roots_.check_read(folder_ / "out/secret.bag"));
  EXPECT_FALSE(roots_.check_write(folder_ / "out/secret.bag"));
  EXPECT_FALSE(roots_.check_read(folder_ / "out/other.bag"));
}

TEST_F(Roots, AFolderThatDoesNotExistIsAnError) {
  const fs::path none = folder_ / "none";
  const auto roots = FileRoots::of({&none, 1});
  ASSERT_FALSE(roots);
  EXPECT_EQ(roots.error().code, ExitCode::kWrongUsage);
}

TEST_F(Roots, EveryCommandWithAFileIsConfined) {
  Explorer explorer(confined());
  for (const fs::path& path : outside()) {
    const std::string file = quoted(path.string());
    for (const std::string& line :
         {"open " + file, "open " + quoted((folder_ / "in/own.bag").string()) + " " + file,
          "save-session " + file, "export-picture " + file, "export-cloud a " + file, "export-curve " + file,
          "export-rig " + file, "use-rig " + file, "export-report " + file, "choose " + file}) {
      const bool optional = line.starts_with("choose ") || (line.starts_with("open ") && line.size() > 10);
      if (path.empty() && optional) continue;
      const auto done = explorer.perform(line);
      ASSERT_FALSE(done) << line;
      EXPECT_NE(done.error().message.find("--root"), std::string::npos)
          << line << ": " << done.error().message;
    }
  }
  EXPECT_FALSE(fs::exists(folder_ / "out/new.json"));
  EXPECT_EQ(explorer.files.replaced_by(
                *parse_call("save-session " + quoted((folder_ / "out/secret.bag").string()))),
            "");
}

TEST_F(Roots, NoRigFileOrTrajectoryIsChosenElsewhere) {
  Explorer explorer(confined());
  ASSERT_TRUE(explorer.perform("choose " + quoted((folder_ / "in/own.bag").string())));
  for (const char* command : {"choose-rig ", "choose-poses "}) {
    const auto done = explorer.perform(command + quoted((folder_ / "in/link.bag").string()));
    ASSERT_FALSE(done) << command;
    EXPECT_NE(done.error().message.find("--root"), std::string::npos) << done.error().message;
  }
}

TEST_F(Roots, ASessionOpensNoRecordingElsewhere) {
  const fs::path session = folder_ / "in/s.json";
  for (const std::string& source :
       {(folder_ / "out/secret.bag").string(), std::string("../out/secret.bag")}) {
    Explorer explorer(confined());
    Explorer free;
    std::string text = session_to_json(session_of(free));
    const std::size_t at = text.find("\"source\": \"");
    ASSERT_NE(at, text.npos) << text;
    text.insert(at + 11, "open " + source);
    std::ofstream(session) << text;
    ASSERT_TRUE(explorer.perform("open " + quoted(session.string())));
    EXPECT_FALSE(explorer.recording.is_opening());
    ASSERT_TRUE(explorer.recording.failure()) << source;
    EXPECT_NE(explorer.recording.failure()->message.find("--root"), std::string::npos);
  }
}

TEST_F(Roots, AFolderOfLinksIsNoWayOut) {
  fs::create_directories(folder_ / "in/tables");
  std::ofstream(folder_ / "out/scans.csv") << "x";
  fs::create_symlink(folder_ / "out/scans.csv", folder_ / "in/tables/scans.csv");
  Explorer explorer(confined());
  ASSERT_TRUE(explorer.perform("open " + quoted((folder_ / "in/tables").string())));
  EXPECT_FALSE(explorer.recording.is_opening());
  EXPECT_TRUE(explorer.recording.failure());
}

}  // namespace
}  // namespace sweepscope::ui
