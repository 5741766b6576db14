#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/cloud_file.hpp"
#include "core/results/estimate_json.hpp"
#include "tests/program.hpp"
#include "tests/render/synthetic_maps.hpp"

namespace sweepscope {
namespace {

class CompareTest : public test::ProgramTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_cloud(folder_ / "wrong.pcd", *test::HallMap(0.03, 20'000).make()));
    ASSERT_TRUE(write_cloud(folder_ / "right.ply", *test::HallMap(0, 20'000).make()));
    ASSERT_TRUE(write_estimate_json(folder_ / "estimate.json", test::stationary_curve()));
  }

  /// Runs `sweepscope compare ARGUMENTS`; returns the exit code and keeps what it said.
  int run(const std::string& environment, const std::string& arguments) {
    const Outcome outcome = ProgramTest::run("compare " + arguments, environment);
    said_ = outcome.out + outcome.err;
    return outcome.exit_code;
  }

  std::string said_;
};

constexpr const char* kArguments = "wrong.pcd right.ply --curve estimate.json --size 960x600";

TEST_F(CompareTest, DrawsTheSameBytesWithNoDisplayAndWithAWrongOne) {
  ASSERT_EQ(run("-u DISPLAY", std::string(kArguments) + " -o none.png"), 0) << said_;
  EXPECT_EQ(std::count(said_.begin(), said_.end(), '\n'), 2) << said_;  // a line for each map, and no more
  EXPECT_EQ(said_.rfind("wrong.pcd: median thickness", 0), 0U) << said_;
  ASSERT_EQ(run("DISPLAY=:99", std::string(kArguments) + " -o wrong.png"), 0) << said_;
  const std::string none = test::contents_of(folder_ / "none.png");
  EXPECT_GT(none.size(), 10'000U);
  EXPECT_EQ(none, test::contents_of(folder_ / "wrong.png"));
}

TEST_F(CompareTest, WritesThePlacesWhereTheMapsDifferMost) {
  ASSERT_EQ(run("-u DISPLAY", std::string(kArguments) + " -o out.png --json places.json"), 0) << said_;
  const auto json = nlohmann::json::parse(test::contents_of(folder_ / "places.json"));
  EXPECT_EQ(json["schema"], "sweepscope.compare/1");
  EXPECT_EQ(json["maps"].size(), 2u);
  ASSERT_FALSE(json["places"].empty());
  EXPECT_EQ(json["places"][0]["most_blurred"], 0);  // wrong.pcd
  EXPECT_EQ(json["places"][0]["cells"].size(), 2u);
  const Outcome alone = ProgramTest::run(std::string("compare ") + kArguments + " -o out.png --json -");
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_EQ(alone.out, test::contents_of(folder_ / "places.json"));  // stdout holds the JSON alone
}

TEST_F(CompareTest, DrawsTheSameBytesInAWindow) {
  ASSERT_EQ(run("-u DISPLAY", std::string(kArguments) + " -o memory.png"), 0) << said_;
  // detect_leaks (of asan): those of Mesa's driver for windows, see tests/ui/window.
  ASSERT_EQ(
      run("-u DISPLAY -u WAYLAND_DISPLAY ASAN_OPTIONS=detect_leaks=0 xvfb-run -a -s '-screen 0 1280x1024x24'",
          std::string(kArguments) + " --draw-in window -o window.png"),
      0)
      << said_;
  EXPECT_EQ(test::contents_of(folder_ / "memory.png"), test::contents_of(folder_ / "window.png"));
  EXPECT_NE(run("-u DISPLAY -u WAYLAND_DISPLAY", std::string(kArguments) + " --draw-in window -o none.png"),
            0);
  EXPECT_FALSE(exists("none.png"));
}

TEST_F(CompareTest, TheNumberOfThreadsDoesNotChangeTheBytes) {
  ASSERT_EQ(run("LP_NUM_THREADS=0", std::string(kArguments) + " -o one.png"), 0) << said_;
  ASSERT_EQ(run("LP_NUM_THREADS=4", std::string(kArguments) + " -o four.png"), 0) << said_;
  EXPECT_EQ(test::contents_of(folder_ / "one.png"), test::contents_of(folder_ / "four.png"));
}

TEST_F(CompareTest, TheFileSaysWhatItIsAndNotWhenOrWhereItWasMade) {
  ASSERT_EQ(run("-u DISPLAY", std::string(kArguments) + " -o out.png"), 0) << said_;
  const std::string bytes = test::contents_of(folder_ / "out.png");
  EXPECT_NE(bytes.find("t_motor = t_laser + offset"), std::string::npos);
  EXPECT_NE(bytes.find("sweepscope " SWEEPSCOPE_VERSION), std::string::npos);
  EXPECT_NE(bytes.find("wrong.pcd; right.ply"), std::string::npos);
  EXPECT_EQ(bytes.find("tIME"), std::string::npos);
  EXPECT_EQ(bytes.find(folder_.string()), std::string::npos);
}

TEST_F(CompareTest, WorksWithoutACurve) {
  EXPECT_EQ(run("-u DISPLAY", "wrong.pcd right.ply -o out.png --size 960x600"), 0) << said_;
}

TEST_F(CompareTest, MapsMayNameTheOffsetsThatTheyWereMadeAt) {
  ASSERT_EQ(run("-u DISPLAY", std::string(kArguments) + " --offsets-ms 19,24 -o out.png"), 0) << said_;
  EXPECT_NE(test::contents_of(folder_ / "out.png").find("wrong.pcd  offset 19.0 ms"), std::string::npos);
  EXPECT_EQ(run("-u DISPLAY", std::string(kArguments) + " --offsets-ms 19 -o out.png"), 2);
}

TEST_F(CompareTest, AFileThatCannotBeReadIsExit3AndLeavesNoPicture) {
  EXPECT_EQ(run("-u DISPLAY", "wrong.pcd none.pcd -o out.png"), 3);
  EXPECT_EQ(said_, "sweepscope: none.pcd: no such file\n");
  EXPECT_EQ(run("-u DISPLAY", "wrong.pcd right.ply --curve right.ply -o out.png"), 3);
  EXPECT_NE(said_.find("right.ply: not JSON"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.png"));
}

TEST_F(CompareTest, WrongUsageIsExit2AndSaysWhatIsWrong) {
  const auto says = [&](const std::string& arguments) {
    EXPECT_EQ(run("-u DISPLAY", arguments), 2) << arguments;
    return said_;
  };
  EXPECT_EQ(says("wrong.pcd -o out.png"), "sweepscope: compare needs two to four maps, not 1\n");
  EXPECT_NE(
      says("wrong.pcd right.ply -o out.png --size 12").find("--size 12: WxH is needed, such as 1920x1200"),
      std::string::npos);
  EXPECT_NE(says("wrong.pcd right.ply -o out.png --size 9999x900").find("sides of 64 to 8000 pixels"),
            std::string::npos);
  EXPECT_NE(says("wrong.pcd right.ply -o out.png --size 100x100").find("too small"), std::string::npos);
  EXPECT_NE(says("wrong.pcd right.ply -o out.png --slab 3:1").find("--slab 3:1"), std::string::npos);
  EXPECT_NE(says("wrong.pcd right.ply -o out.png --colour-table jet").find("viridis, cividis, turbo, grey"),
            std::string::npos);
  EXPECT_NE(
      says("wrong.pcd right.ply -o none/out.png --size 960x600").find("none/out.png: cannot be created"),
      std::string::npos);
}

}  // namespace
}  // namespace sweepscope
