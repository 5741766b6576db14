#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/core/recording/test_bag.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

using test::Outcome;

Outcome run_info(const test::ScratchFolder& folder, const std::string& arguments) {
  return test::run_program(folder.path(), "info " + arguments);
}

std::string quoted(const std::filesystem::path& path) {
  return fmt::format("'{}'", path.string());
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Info, ShowsWhatIsInARecording) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag", "lz4");
  const Outcome run = run_info(folder, quoted(folder / "a.bag"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(holds(run.out, "  /scan          sensor_msgs/LaserScan       160  the laser\n")) << run.out;
  EXPECT_TRUE(holds(run.out, "  rate       40.00 Hz over 3.975 s, no gaps\n")) << run.out;
  EXPECT_TRUE(holds(run.out, "  joint      roll_motor on /joint_states, 420 samples\n")) << run.out;
  EXPECT_TRUE(holds(run.out, "  speed      229.2 deg/s (median of the sweeps): 1 ms is 0.229 deg\n"))
      << run.out;
  EXPECT_TRUE(holds(run.out, "expected accuracy\n")) << run.out;
}

TEST(Info, OfAMotorThatTurnsOneWayCountsTurnsAndNamesWhatAnswers) {
  const test::ScratchFolder folder;
  ASSERT_EQ(test::run_program(folder.path(), "simulate room-1 -o spin.bag --motor one-way --duration-s 4")
                .exit_code,
            0);
  const Outcome run = run_info(folder, "spin.bag");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(holds(run.out, "  turns      4.6, all one way: no reversals, so no sweeps\n")) << run.out;
  EXPECT_FALSE(holds(run.out, "0 whole")) << run.out;
  EXPECT_TRUE(holds(run.out, "cannot be distinguished from the encoder's zero")) << run.out;
  EXPECT_TRUE(holds(run.out, "(estimate --solve mount)")) << run.out;
}

TEST(Info, JsonOnStdoutIsAlone) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  const Outcome run = run_info(folder, quoted(folder / "a.bag") + " --json -");
  EXPECT_EQ(run.exit_code, 0);
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["schema"], "sweepscope.info/1");
  EXPECT_EQ(json["laser"]["used"], 160);
  EXPECT_EQ(json["motor"]["joint"], "roll_motor");
  EXPECT_TRUE(json["motion"].is_null()) << "five beams a scan tell nothing";
}

TEST(Info, JsonInAFileIsTheSame) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  const Outcome run = run_info(folder, quoted(folder / "a.bag") + " --json " + quoted(folder / "a.json"));
  EXPECT_TRUE(holds(run.out, "a.bag\n"));
  EXPECT_EQ(test::contents_of(folder / "a.json"),
            run_info(folder, quoted(folder / "a.bag") + " --json -").out);
}

TEST(Info, WarningsOfACutBagAreOnStderr) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  const std::string whole = test::contents_of(folder / "a.bag");
  test::write_file(folder / "cut.bag", whole.substr(0, whole.size() / 2));
  const Outcome run = run_info(folder, quoted(folder / "cut.bag"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_TRUE(holds(run.err, "warning: cut.bag: it is cut short: the record at byte ")) << run.err;
}

TEST(Info, WhatCannotBeReadIsExitCode3AndLeavesNoFile) {
  const test::ScratchFolder folder;
  test::write_file(folder / "a.txt", "no recording");
  const Outcome run = run_info(folder, quoted(folder / "a.txt") + " --json " + quoted(folder / "a.json"));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(holds(run.err, "a.txt: its first bytes are not those of a known recording format")) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
  EXPECT_EQ(run_info(folder, quoted(folder / "missing.bag")).exit_code, 3);
}

TEST(Info, ABadRigFileIsExitCode3WithItsPlace) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  test::write_file(folder / "rig.yaml", "mount: {axes: [1, 0, 0]}\n");
  const Outcome run = run_info(folder, quoted(folder / "a.bag") + " --rig " + quoted(folder / "rig.yaml"));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_TRUE(holds(run.err, "rig.yaml:1:9: unknown key \"axes\" in mount")) << run.err;
}

TEST(Info, ReceiveTimesAreUsedWhereAskedFor) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  const Outcome run = run_info(folder, quoted(folder / "a.bag") + " --stamps receive --json -");
  EXPECT_EQ(nlohmann::json::parse(run.out)["laser"]["stamp"], "receive");
}

TEST(Info, AWindowCutsTheRecording) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  const Outcome run = run_info(folder, quoted(folder / "a.bag") + " --window 1:2 --json -");
  EXPECT_EQ(nlohmann::json::parse(run.out)["laser"]["used"], 41);
}

TEST(Info, WrongUsageIsExitCode2) {
  const test::ScratchFolder folder;
  test::write_sample_bag(folder / "a.bag");
  EXPECT_EQ(run_info(folder, "").exit_code, 2);
  EXPECT_EQ(run_info(folder, quoted(folder / "a.bag") + " --stamps both").exit_code, 2);
  for (const char* window : {"5", "5:3", "a:b", "1:nan", ":", "1:1"}) {
    EXPECT_EQ(run_info(folder, quoted(folder / "a.bag") + " --window " + window).exit_code, 2) << window;
  }
  const Outcome beyond = run_info(folder, quoted(folder / "a.bag") + " --window 100:200");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_TRUE(holds(beyond.err, "no scan lies between 100 and 200 s; the last one is at 3.975 s"))
      << beyond.err;
}

}  // namespace
}  // namespace sweepscope
