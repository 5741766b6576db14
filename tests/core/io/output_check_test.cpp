#include "core/io/output_check.hpp"

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

class OutputCheck : public test::FolderTest {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "in.bag") << "recording";
    fs::create_directory(folder_ / "sub");
  }
  /// What is said of `output` beside the input in.bag; empty where it may be written.
  std::string said_of(const fs::path& output) const { return said({{folder_ / "in.bag"}, {output}, {}}); }
  static std::string said(const RunFiles& files) {
    const auto checked = check_run_files(files);
    if (checked) return "";
    EXPECT_EQ(checked.error().code, ExitCode::kWrongUsage);
    return checked.error().message;
  }
};

TEST_F(OutputCheck, RefusesAnInputByName) {
  const std::string name = (folder_ / "in.bag").string();
  EXPECT_EQ(said_of(name), name + ": is an input of this command and would be overwritten");
  EXPECT_NE(said_of(folder_ / "sub/../in.bag"), "");
}

TEST_F(OutputCheck, RefusesAnInputByHardLinkAndBySymbolicLink) {
  fs::create_hard_link(folder_ / "in.bag", folder_ / "hard.json");
  fs::create_symlink("in.bag", folder_ / "soft.json");
  fs::create_directory_symlink(folder_, folder_ / "sub/up");
  EXPECT_NE(said_of(folder_ / "hard.json").find("is the same file as the input"), std::string::npos);
  EXPECT_NE(said_of(folder_ / "soft.json").find("is the same file as the input"), std::string::npos);
  EXPECT_NE(said_of(folder_ / "sub/up/in.bag"), "");
}

TEST_F(OutputCheck, RefusesTwoOutputsThatAreOneFile) {
  const fs::path out = folder_ / "out.json";
  EXPECT_EQ(said({{}, {out, out}, {}}),
            out.string() + ": two outputs of this command would be written to it");
  EXPECT_NE(said({{}, {out, folder_ / "sub/../out.json"}, {}}).find("is the same file as the output"),
            std::string::npos);
  fs::create_symlink("out.json", folder_ / "dangling");
  EXPECT_NE(said({{}, {out, folder_ / "dangling"}, {}}), "") << "though neither exists yet";
  EXPECT_EQ(said({{}, {out, folder_ / "sub/out.json"}, {}}), "");
}

TEST_F(OutputCheck, LetsOtherFilesBeReplaced) {
  std::ofstream(folder_ / "old.json") << "old";
  EXPECT_EQ(said_of(folder_ / "old.json"), "");
  EXPECT_EQ(said_of(folder_ / "new.json"), "");
}

TEST_F(OutputCheck, LetsOneDeviceTakeAllOutputs) {
  EXPECT_EQ(said({{"/dev/null"}, {"/dev/null", "/dev/null"}, {}}), "");
}

TEST_F(OutputCheck, RefusesWhatCannotBeCreated) {
  const fs::path out = folder_ / "missing/out.json";
  EXPECT_EQ(said_of(out), out.string() + ": cannot be created: No such file or directory");
}

TEST_F(OutputCheck, AFolderThatTheRunMakesMayBeMissing) {
  const fs::path made = folder_ / "made/deep";
  EXPECT_EQ(said({{}, {made / "out.json"}, made}), "");
  EXPECT_FALSE(fs::exists(made));
  const fs::path below_a_file = folder_ / "in.bag/made";
  EXPECT_EQ(said({{}, {below_a_file / "out.json"}, below_a_file}),
            (folder_ / "in.bag").string() + ": is not a folder");
}

}  // namespace
}  // namespace sweepscope
