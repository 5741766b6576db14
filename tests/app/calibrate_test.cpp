#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/app/self_signal.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

/// room.bag, and its lines as a driver would send them: stream.csv, in the order of time.
class CalibrateCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    make({"simulate room-1 --duration-s 6 --offset-ms 17.3 -o room.bag", "convert room.bag -o tables"});
    std::ofstream stream(folder_ / "stream.csv");
    std::multimap<std::string, std::string> lines;  // by the stamp, whose digits are as many everywhere
    for (const char* word : {"scan", "motor"}) {
      std::ifstream table(folder_ / (word == std::string("scan") ? "tables/scans.csv" : "tables/motor.csv"));
      std::string line;
      std::getline(table, line);
      stream << word << ',' << line << '\n';
      while (std::getline(table, line)) lines.emplace(line.substr(0, line.find(',')), word + (',' + line));
    }
    for (const auto& [stamp, line] : lines) stream << line << '\n';
  }
  /// The offset in ms and all else that an estimate's JSON says.
  static nlohmann::json parsed(const std::string& text) {
    return nlohmann::json::parse(text, nullptr, false);
  }
};

const std::string kOwnTime = test::preloaded(SWEEPSCOPE_OWN_TIME);

TEST_F(CalibrateCommand, FindsWhatEstimateFindsInTheSameRecording) {
  const Outcome live = run("calibrate - --seconds 60 --record kept.bag --json - --no-timing <stream.csv");
  ASSERT_EQ(live.exit_code, 0) << live.err;
  const Outcome file = run("estimate room.bag --json - --no-timing");
  const auto said = parsed(live.out), expected = parsed(file.out);
  ASSERT_TRUE(said.is_object()) << live.out;
  EXPECT_EQ(said["offset_ms"], expected["offset_ms"]);
  EXPECT_EQ(said["sigma_ms"], expected["sigma_ms"]);
  EXPECT_EQ(said["schema"], expected["schema"]);
  EXPECT_EQ(said["kind"], "stationary");
  EXPECT_NEAR(said["offset_ms"].get<double>(), 17.3, 0.1);
  EXPECT_NE(said["warnings"].dump().find("The input ended after"), std::string::npos);
  const auto kept = parsed(run("estimate kept.bag --json - --no-timing").out);
  EXPECT_EQ(kept["offset_ms"], expected["offset_ms"]);
}

TEST_F(CalibrateCommand, NamesTheLaserAndTheJointAsOtherCommandsDo) {
  const std::string calibrate = "calibrate - --seconds 60 --json - --no-timing";
  const Outcome named = run(calibrate + " --laser /scan --joint roll_motor <stream.csv");
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_EQ(parsed(named.out)["offset_ms"], parsed(run(calibrate + " <stream.csv").out)["offset_ms"]);
  const Outcome wrong = run(calibrate + " --joint wheel <stream.csv");
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_EQ(parsed(wrong.out)["reasons"].at(0), "No motor angles of the joint wheel were received.")
      << wrong.out;
}

TEST_F(CalibrateCommand, HearsForTheSecondsAskedForAndSaysHowFarItIs) {
  const Outcome outcome = run("calibrate - --seconds 4.5 --record kept <stream.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.rfind("offset   17.", 0), 0U) << outcome.out;
  EXPECT_TRUE(exists("kept/scans.csv"));
  EXPECT_TRUE(exists("kept/motor.csv"));
}

TEST_F(CalibrateCommand, AnInterruptionEndsTheListeningAndUsesWhatWasHeard) {
  // The input stays open behind what there is; the signal comes once all of that was taken. The 5 s after
  // which other commands end are over at once.
  std::ofstream(folder_ / "interrupt.sh") << "mkfifo lines taken\n"
                                             "(cat stream.csv; echo >taken; exec sleep infinity) >lines &\n"
                                             "feeder=$!\n"
                                             "env \"$@\" calibrate - --seconds 300 --silence-s 300 "
                                             "--record kept.mcap --json out.json <lines &\n"
                                             "calibrate=$!\n"
                                             "read <taken\n"
                                             "kill -TERM $calibrate; wait $calibrate; code=$?\n"
                                             "kill $feeder\n"
                                             "exit $code\n";
  const Outcome interrupted =
      test::run_shell(folder_, "bash interrupt.sh " + kOwnTime + " '" SWEEPSCOPE_EXECUTABLE "'");
  EXPECT_EQ(interrupted.exit_code, 0) << interrupted.err;
  const auto said = parsed(test::contents_of(folder_ / "out.json"));
  ASSERT_TRUE(said.is_object());
  EXPECT_NEAR(said["offset_ms"].get<double>(), 17.3, 0.1);
  EXPECT_NE(said["warnings"].dump().find("Interrupted after"), std::string::npos) << said["warnings"];
  EXPECT_TRUE(exists("kept.mcap"));
}

TEST_F(CalibrateCommand, WhatIsTooLittleIsRefused) {
  const Outcome nothing = run("calibrate - --json - </dev/null");
  EXPECT_EQ(nothing.exit_code, 4) << nothing.err;
  EXPECT_EQ(parsed(nothing.out)["identifiable"], false);
  EXPECT_EQ(parsed(nothing.out)["reasons"][0], "No scans were received.");
  const Outcome wrong = run("calibrate - <tables/scans.csv --record kept.bag");
  EXPECT_EQ(wrong.exit_code, 4) << wrong.err;
  EXPECT_NE(wrong.err.find("begins with neither scan nor motor"), std::string::npos) << wrong.err;
  EXPECT_FALSE(exists("kept.bag"));
  EXPECT_EQ(run("calibrate").exit_code, 2);
  EXPECT_EQ(run("calibrate - --record out.xyz </dev/null").exit_code, 2);
}

TEST_F(CalibrateCommand, WhatDoesNotAdvanceEndsItWithTheTrueReason) {
  std::ofstream(folder_ / "endless.sh") << "grep -m 1 ^motor stream.csv; grep -m 1 ^scan stream.csv\n"
                                           "exec yes \"$(grep -m 1 \"^$1,1\" stream.csv)\" 2>/dev/null\n";
  const auto reason = [&](const std::string& word) {
    const Outcome outcome =
        test::run_shell(folder_, "bash endless.sh " + word + " | env " + kOwnTime +
                                     " '" SWEEPSCOPE_EXECUTABLE
                                     "' calibrate - --silence-s 0.5 --seconds 600 --json said.json");
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    return parsed(test::contents_of(folder_ / "said.json"))["reasons"][0].get<std::string>();
  };
  EXPECT_EQ(reason("motor").rfind("No scan arrived for 0.5 s, after 0.0 of 600 s; ", 0), 0U)
      << reason("motor");
  EXPECT_EQ(reason("scan").rfind("The scans' stamps did not advance for 0.5 s: ", 0), 0U) << reason("scan");
}

TEST_F(CalibrateCommand, AnAddressThatIsNoneIsRefused) {
  if (run("calibrate --help").out.find("or ros for") == std::string::npos)
    GTEST_SKIP() << "this build has no ROS";
  for (const char* address : {"", "foo", "http://", "http://localhost", "http://:11311", "http://localhost:0",
                              "http://localhost:99999999", "http://localhost:11311abc",
                              "https://localhost:11311", "http://local host:11311", "http://localhost:-5"}) {
    const Outcome outcome = run("calibrate ros", std::string("'ROS_MASTER_URI=") + address + "'");
    EXPECT_EQ(outcome.exit_code, 3) << address << outcome.err;
    EXPECT_EQ(outcome.err, std::string("sweepscope: ROS: ROS_MASTER_URI=\"") + address +
                               "\" is not the address of a master, such as http://localhost:11311\n");
  }
  const Outcome unset = run("calibrate ros", "-u ROS_MASTER_URI");
  EXPECT_EQ(unset.exit_code, 3) << unset.err;
}

TEST_F(CalibrateCommand, NoCommandLeavesAnythingOfRossInTheHomeFolder) {
  std::filesystem::create_directory(folder_ / "home");
  std::filesystem::create_directory(folder_ / "temporary");
  const auto at = [&](const char* name) { return "'" + (folder_ / name).string() + "'"; };
  const std::string plain =
      "-u ROS_LOG_DIR -u ROS_HOME ROS_MASTER_URI=http://localhost:9 TMPDIR=" + at("temporary") +
      " HOME=" + at("home");
  // Where ROS_HOME does not say it, rospack asks the system for the home folder and not the environment.
  for (const std::string& environment :
       {plain, plain + " ROS_HOME=" + at("home/.ros"), plain + " ROS_HOME=" + at("missing/.ros")}) {
    for (const char* command :
         {"simulate room-1 --duration-s 1 -o made.bag", "info made.bag", "convert made.bag -o again.bag",
          "convert made.bag -o again.mcap", "calibrate ros"}) {
      const Outcome outcome = run(command, environment);
      const bool listens = std::string(command) == "calibrate ros";
      EXPECT_EQ(outcome.exit_code, listens ? 3 : 0) << command << ": " << outcome.err;
      EXPECT_EQ(outcome.err.find("[rospack]"), std::string::npos) << command << ": " << outcome.err;
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "home"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "temporary"));
    EXPECT_FALSE(exists("missing"));
  }
}

TEST_F(CalibrateCommand, AFoxgloveServerHasAnAddressAndMustBeThere) {
  EXPECT_EQ(run("calibrate foxglove").exit_code, 2);
  EXPECT_EQ(run("calibrate foxglove localhost:8765").exit_code, 2);
  EXPECT_EQ(run("calibrate - ws://localhost:8765 <stream.csv").exit_code, 2);
  const Outcome nobody = run("calibrate foxglove ws://127.0.0.1:9 --record kept.mcap --json out.json");
  EXPECT_EQ(nobody.exit_code, 3);
  EXPECT_NE(nobody.err.find("ws://127.0.0.1:9/: cannot be reached"), std::string::npos) << nobody.err;
  EXPECT_FALSE(exists("kept.mcap"));
  EXPECT_FALSE(exists("out.json"));
}

}  // namespace
}  // namespace sweepscope
