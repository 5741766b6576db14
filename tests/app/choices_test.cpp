// Recordings that need choosing: on the command line and on the explorer's page.
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/io/atomic_file.hpp"
#include "core/recording/csv/csv_recording.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "tests/core/cloud_bench.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/written_message.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

/// The folder `rec`: tables of a room whose scanner is on /scan and whose motor is the joint roll_motor. A
/// test adds to them.
class Choices : public test::ProgramTest {
 protected:
  void SetUp() override {
    make({"simulate room-3 -o room.bag --duration-s 5"});
    const auto raw = read_raw_recording(folder_ / "room.bag", {}, Job());
    ASSERT_TRUE(raw);
    ASSERT_TRUE(write_csv_recording(raw->lasers.at(0), raw->joints.at(0), folder_ / "rec", Job()));
  }

  /// Every line of a table once more, with one word replaced by another.
  void repeat_with(const std::string& table, const std::string& word, const std::string& other) const {
    std::string text = read_file(folder_ / "rec" / table).value();
    std::string more = text.substr(text.find('\n') + 1);
    for (std::size_t at = 0; (at = more.find(word, at)) != std::string::npos; at += other.size())
      more.replace(at, word.size(), other);
    ASSERT_NE(more, text.substr(text.find('\n') + 1)) << word;
    ASSERT_TRUE(write_file(folder_ / "rec" / table, text + more));
  }
  void add_laser() const { repeat_with("scans.csv", "/scan", "/back"); }
  void add_joint() const { repeat_with("motor.csv", "roll_motor", "wheel"); }

  /// A ROS 1 bag as a Livox driver and a motor's would have it recorded, and livox.yaml with how the scanner
  /// is mounted.
  void write_livox(const test::CloudBench& bench, bool with_motor = true) const {
    const std::map<std::string, std::string> md5sums{
        {"sensor_msgs/JointState", "3066dcd76a6cfaef579bd0f34173e9fd"},
        {"livox_ros_driver/CustomMsg", "e4d6829bdfe657cb6c21a746c86b21a6"}};
    test::TestBag bag(folder_ / "livox.bag");
    bench.play(test::MessageBytes::kRos1,
               [&](const char* topic, const char* type, std::int64_t receive_ns, const std::string& bytes) {
                 if (!with_motor && std::string_view(type) == "sensor_msgs/JointState") return;
                 bag.write(topic, static_cast<double>(receive_ns) * 1e-9,
                           test::WrittenMessage{type, md5sums.at(type), bytes});
               });
    bag.close();
    std::ofstream(folder_ / "livox.yaml")
        << "mount: {axis: [0, 1, 0], laser_in_motor: {xyz_m: [0.05, 0, 0.08]}}\n";
  }

  void view(const std::string& script, int exit_code = 0, const std::string& options = "") const {
    std::ofstream(folder_ / "test.script") << script;
    const Outcome outcome =
        run("view " + options + " --headless --no-estimate --size 1024x768 --script test.script");
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  }
};

TEST_F(Choices, SeveralLasersAndJointsAreNamedOnTheCommandLine) {
  add_laser();
  add_joint();
  EXPECT_EQ(run("info rec").exit_code, 3);
  EXPECT_EQ(run("info rec --laser /scan").exit_code, 3);
  const Outcome info = run("info rec --laser /back --joint wheel");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("/back"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("wheel"), std::string::npos) << info.out;
  const Outcome of_bag = run("estimate room.bag --json - --no-timing"),
                of_choice = run("estimate rec --laser /scan --joint roll_motor --json - --no-timing");
  ASSERT_EQ(of_choice.exit_code, 0) << of_choice.err;
  EXPECT_EQ(nlohmann::json::parse(of_choice.out)["offset_ms"],
            nlohmann::json::parse(of_bag.out)["offset_ms"]);
  const Outcome wrong = run("info rec --laser /side --joint wheel");
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_NE(wrong.err.find("/side"), std::string::npos) << wrong.err;
}

TEST_F(Choices, TheCommandsThatWriteTakeTheSameNames) {
  add_laser();
  add_joint();
  const std::string names = " --laser /scan --joint roll_motor";
  for (const std::string command :
       {"convert rec -o out.bag", "rig rec", "apply rec --offset-ms 24 --clouds-only out"}) {
    const Outcome ambiguous = run(command);
    EXPECT_EQ(ambiguous.exit_code, 3) << command;
    const Outcome named = run(command + names);
    EXPECT_EQ(named.exit_code, 0) << command << ": " << named.err;
  }
  EXPECT_NE(run("rig rec" + names).out.find("roll_motor"), std::string::npos);
  // What was converted holds these two alone.
  EXPECT_EQ(run("info out.bag").exit_code, 0);
  std::ofstream(folder_ / "rig.yaml") << run("rig room.bag").out;
  EXPECT_EQ(run("rig rig.yaml --as urdf --offset-ms 24 --laser /scan").exit_code, 2);
}

TEST_F(Choices, TwoLasersGiveAPageAndOpenOnceOneIsChosen) {
  add_laser();
  view(
      "open rec\nwait loaded\nexpect page is choices\n"
      "expect chosen-problem is 2 topics hold scans. Choose the scanner that the motor turns.\n"
      "expect chosen-laser is\nexpect chosen-motor is roll_motor\nexpect message is\n"
      "choose-laser /back\nwait loaded\nexpect chosen-laser is /back\nexpect chosen-problem is\n"
      "expect chosen-parts is 1\n"
      "open-chosen\nwait loaded\nexpect page is maps\nexpect recording is rec\n"
      "copy-command\nexpect message contains view rec --laser /back --headless\n"
      "save-session s.json\n");
  // The session alone opens it again, and so does what was copied.
  view("wait loaded\nexpect page is maps\nexpect recording is rec\n", 0, "s.json");
  view("wait loaded\nexpect page is maps\n", 0, "rec --laser /back");
  const auto session = nlohmann::json::parse(read_file(folder_ / "s.json").value());
  EXPECT_EQ(session["reading"], nlohmann::json({{"laser", "/back"}}));
  EXPECT_EQ(session["source"], "open rec");
}

TEST_F(Choices, TwoJointsAreChosenByTheMouse) {
  add_joint();
  view(
      "open rec\nwait loaded\nexpect chosen-laser is /scan\nexpect chosen-motor is\n"
      "expect chosen-problem is 2 of 2 joints turn. Choose the one that turns the scanner.\n"
      "click \"choose-motor\"\nclick \"choose-motor wheel /joint_states\"\nwait loaded\n"
      "expect chosen-motor is wheel\nclick \"button open-chosen\"\nwait loaded\nexpect page is maps\n"
      "copy-command\nexpect message contains --motor /joint_states --joint wheel\n");
}

TEST_F(Choices, ThePageWorksByTheKeyboard) {
  view(
      "open rec\nwait solved\nkey Ctrl+Shift+O\nwait loaded\nexpect page is choices\n"
      "key E\nkey Escape\nexpect page is maps\nexpect estimate is none\n"
      "key Ctrl+Shift+O\nwait loaded\nexpect chosen-laser is /scan\nchoose-part 1 4\nkey Enter\nwait loaded\n"
      "expect page is maps\ncopy-command\nexpect message contains --window 1:4\n");
}

TEST_F(Choices, APartInTimeIsDraggedOnTheStripOfWhereTheRigStood) {
  view(
      "choose rec\nwait loaded\nexpect chosen-parts is 1\n"
      "drag \"choose-part\" at 0.995 0.5 to \"choose-part\" at 0.5 0.5\nopen-chosen\nwait loaded\n"
      "copy-command\nexpect message contains --window 0:2.5\n");
}

TEST_F(Choices, ThePageSaysHowTheBeamsAreRead) {
  make({"simulate room-3 -o reversed.bag --duration-s 4 --sweep-s 0.513 --beam-times reversed"});
  view("choose rec\nwait loaded\nexpect chosen-reading is recorded\n");
  view("choose reversed.bag\nwait loaded\nexpect chosen-reading is reversed\nexpect chosen-parts is 1\n");
}

TEST_F(Choices, ARecordingThatNeedsARigFileIsOpenedWithOne) {
  add_laser();
  std::ofstream(folder_ / "rig.yaml") << "laser: {topic: /scan}\nmount: {axis: [0, 1, 0]}\n";
  view(
      "open rec\nwait loaded\nexpect page is choices\nclick \"button ask choose-rig\"\n"
      "key Escape\nexpect page is choices\n"
      "click \"button ask choose-rig\"\ntype rig.yaml\nkey Enter\nwait loaded\n"
      "expect chosen-laser is /scan\nexpect chosen-problem is\nopen-chosen\nwait loaded\nexpect page is "
      "maps\n"
      "copy-command\nexpect message contains --rig rig.yaml\nsave-session s.json\n");
  view("wait loaded\nexpect page is maps\n", 0, "s.json");
}

TEST_F(Choices, ARigFileThatCannotBeReadStaysOnThePageWithItsReason) {
  std::ofstream(folder_ / "rig.yaml") << "laser: {tropic: /scan}\n";
  view(
      "choose rec\nwait loaded\nchoose-rig rig.yaml\nwait loaded\nexpect chosen-problem contains rig.yaml\n"
      "open-chosen\nwait loaded\nexpect page is choices\nexpect chosen-problem contains tropic\n"
      "choose-rig\nwait loaded\nexpect chosen-problem is\nopen-chosen\nwait loaded\nexpect page is maps\n");
}

TEST_F(Choices, APartWithoutScansAndPosesThatDoNotFitStayOnThePage) {
  std::ofstream(folder_ / "far.tum") << "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n";
  view(
      "choose rec\nwait loaded\nchoose-part 100 200\nopen-chosen\nwait loaded\nexpect page is choices\n"
      "expect chosen-problem contains no scan lies between\nchoose-part 0 0\nchoose-poses "
      "far.tum\nopen-chosen\n"
      "wait loaded\nexpect page is choices\nexpect chosen-problem contains poses\nchoose-poses\nopen-chosen\n"
      "wait loaded\nexpect page is maps\n");
}

TEST_F(Choices, AScriptThatDoesNotChooseEndsWithTheReason) {
  add_laser();
  const Outcome outcome =
      run("view rec --headless --no-estimate --run 'wait solved; screenshot picture.png'");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("2 topics of scans"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("picture.png"));
  view("choose-laser /scan\nopen-chosen\nwait loaded\nexpect page is maps\n", 0, "rec");
}

TEST_F(Choices, WhatHoldsNoStreamsGivesAMessageAndNoPage) {
  std::ofstream(folder_ / "text.bag") << "not a recording";
  view("open text.bag\nwait loaded\nexpect page is start\nexpect message contains text.bag\n");
  view("choose missing.bag\n", 3);
  view("choose-laser /scan\n", 2);
  view("open-chosen\n", 2);
}

TEST_F(Choices, ASessionWithChoicesOfTheWrongKindIsRefusedWithTheKey) {
  view("open rec\nwait loaded\nsave-session s.json\n");
  auto session = nlohmann::ordered_json::parse(read_file(folder_ / "s.json").value());
  EXPECT_FALSE(session.contains("reading")) << "everything was detected";
  session["reading"] = {{"stamps", "sundial"}};
  std::ofstream(folder_ / "bad.json") << session.dump();
  view(
      "open bad.json\nwait loaded\nexpect page is start\nexpect message contains neither header nor "
      "receive\n");
}

TEST_F(Choices, CloudsOfA3dScannerAreListedAndOpenWithTheirMount) {
  test::CloudBench bench;
  bench.rings = 4;
  bench.beams = 200;
  bench.duration_s = 9;
  const RawRecording raw = bench.raw(CloudDetail::kWhole);
  ASSERT_TRUE(write_recording(raw.lasers.at(0), raw.joints.at(0), RecordingFormat::kRos1, "none",
                              folder_ / "clouds.bag", Job()));
  std::ofstream(folder_ / "rig.yaml")
      << "mount: {axis: [0, 1, 0], laser_in_motor: {xyz_m: [0.05, 0, 0.08]}}\n";
  view(
      "choose clouds.bag\nwait loaded\nexpect chosen-laser is /points\nchoose-rig rig.yaml\nwait loaded\n"
      "expect chosen-problem is\nopen-chosen\nwait loaded\nexpect page is maps\nexpect recording is "
      "clouds.bag\n"
      "copy-command\nexpect message contains view clouds.bag --rig rig.yaml\n");
}

test::CloudBench livox_bench() {
  test::CloudBench bench;
  bench.driver = test::CloudBench::Driver::kLivox;
  bench.rings = 4;
  bench.duration_s = 9;
  return bench;
}

TEST_F(Choices, ALivoxScannersBagIsOpenedEstimatedAndShown) {
  const test::CloudBench bench = livox_bench();
  write_livox(bench);
  view(
      "choose livox.bag\nwait loaded\nexpect chosen-laser is /points\nexpect chosen-motor is tilt\n"
      "expect chosen-problem is\nchoose-rig livox.yaml\nwait loaded\nopen-chosen\nwait solved\n"
      "expect page is maps\nexpect kind is stationary\nexpect state-a is solved\nexpect points-a above "
      "10000\n"
      "estimate\nwait solved\nexpect estimate is found\nexpect found-ms near 24.3 0.5\n"
      "expect offset-b near 24.3 0.5\nexpect state-b is solved\nexpect points-b above 10000\n");
}

TEST_F(Choices, ALivoxPatternThatDoesNotRepeatItselfIsAnsweredByTheStationaryMethod) {
  test::CloudBench bench = livox_bench();
  bench.rosette = true;
  bench.rings = 2;
  bench.beams = 1000;
  bench.duration_s = 14;
  write_livox(bench);
  view(
      "wait solved\nexpect page is maps\nestimate\nwait solved\nexpect estimate is refused\n"
      "method stationary\nsearch range\nsearch-range 18 30 2\nestimate\nwait solved\n"
      "expect estimate is found\nexpect found-ms near 24.3 1\nexpect points-b above 10000\n",
      0, "livox.bag --rig livox.yaml");
}

TEST_F(Choices, ABagWithoutAMotorGivesThePageThatSaysSo) {
  write_livox(livox_bench(), false);
  const std::string problem =
      "No topic holds the angle of a motor: joint states, numbers or transforms. Topics: /points "
      "(CustomMsg).";
  view(
      "open livox.bag\nwait loaded\nexpect page is choices\nexpect chosen-laser is /points\n"
      "expect chosen-motor is\nexpect chosen-problem is " +
      problem +
      "\nclick \"button open-chosen\"\nwait loaded\nexpect page is choices\nexpect chosen-problem is " +
      problem + "\nkey Escape\nexpect page is start\n");
}

}  // namespace
}  // namespace sweepscope
