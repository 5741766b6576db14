// What the explorer opens and writes: recordings, sessions, estimates, exports and rig files.
#include <gtest/gtest.h>

#include "core/io/atomic_file.hpp"
#include "core/io/cloud_file.hpp"
#include "core/results/estimate_json.hpp"
#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/explorer/observables.hpp"

namespace sweepscope::ui {
namespace {

using test::InARoom, test::perform, test::rest, test::scratch;

TEST_F(InARoom, ASessionBringsEverythingBack) {
  for (const char* line :
       {"offset-a 19", "offset-b 23.5", "layout swipe", "table cividis", "camera-a 1 1 0 7 30 40"})
    perform(explorer_, line);
  const std::string path = scratch("session.json").string();
  perform(explorer_, "save-session " + path);
  Explorer other;
  perform(other, "open " + path);
  rest(other);
  EXPECT_EQ(other.settings(), explorer_.settings());
  EXPECT_EQ(session_to_json(session_of(other)), session_to_json(session_of(explorer_)));
  EXPECT_EQ(observe(other, "recording"), "room-1");
  std::filesystem::remove(path);
}

TEST_F(InARoom, AnExportedMapHoldsThePointsShownInTheOrderOfTime) {
  const std::string path = scratch("map.pcd").string();
  perform(explorer_, "export-cloud b " + path);
  rest(explorer_);
  const auto cloud = read_cloud(path);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ((*cloud)->size(), explorer_.pane(Side::kB).full->points->size());
  for (std::size_t i = 1; i < (*cloud)->size(); ++i)
    EXPECT_LE((*cloud)->points[i - 1].time_s, (*cloud)->points[i].time_s);
  std::filesystem::remove(path);
}

TEST(Failures, ABrokenFileGivesASentenceAndTheExplorerLivesOn) {
  const std::string path = scratch("broken.bag").string();
  ASSERT_TRUE(write_file(path, "#ROSBAG V2.0\nand then nothing of the kind"));
  Explorer explorer;
  perform(explorer, "open " + path);
  rest(explorer);
  ASSERT_TRUE(explorer.messages.shown());
  EXPECT_NE(explorer.messages.shown()->text.find("broken.bag"), std::string::npos);
  perform(explorer, "sample room-2");
  rest(explorer);
  EXPECT_NE(explorer.loaded(), nullptr);
  EXPECT_FALSE(explorer.messages.shown());
  perform(explorer, "open " + path);
  rest(explorer);
  EXPECT_EQ(observe(explorer, "recording"), "room-2") << "what was open stays open";
  std::filesystem::remove(path);
}

TEST_F(InARoom, AnEstimateFromAFileIsShownAsIfItHadBeenMadeHere) {
  const std::string path = scratch("estimate.json").string();
  Estimate estimate;
  estimate.recording = "room-1";
  estimate.method = Method::kStationary;
  estimate.identifiable = true;
  estimate.offset_s = 0.0235;
  ASSERT_TRUE(write_estimate_json(path, estimate, Timing::kNull));
  perform(explorer_, "open " + path);
  EXPECT_EQ(observe(explorer_, "found-ms"), "23.5000");
  EXPECT_EQ(explorer_.settings().offset_b_ms, 23.5);
  EXPECT_EQ(observe(explorer_, "recording"), "room-1") << "the recording stays";
  std::filesystem::remove(path);
}

TEST_F(InARoom, AnExportThatFailsSaysSoAndIsForgottenOnce) {
  perform(explorer_, "export-cloud a /dev/full");
  rest(explorer_);
  ASSERT_TRUE(explorer_.messages.shown());
  EXPECT_NE(explorer_.messages.shown()->text.find("/dev/full"), std::string::npos);
  EXPECT_TRUE(explorer_.exports.take_failure());
  EXPECT_FALSE(explorer_.exports.take_failure());
}

TEST_F(InARoom, AnExportThatCannotBeginIsRefusedAtOnce) {
  const auto done = explorer_.perform("export-cloud a /nowhere/map.pcd");
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "/nowhere/map.pcd: cannot be created: No such file or directory");
}

TEST_F(InARoom, WhatIsSolvedForIsFoundWithTheOffsetAndSavedAsARigFile) {
  perform(explorer_, "solve-for offset,mount");
  perform(explorer_, "estimate");
  rest(explorer_);
  const std::string found = observe(explorer_, "found-rig").value();
  EXPECT_TRUE(found.starts_with("mount roll 0.00°, kept; mount pitch ")) << found;
  EXPECT_NE(found.find("±"), std::string::npos) << found;
  EXPECT_NE(command_line(explorer_, 800, 600).find("solve-for offset,mount"), std::string::npos);
  const std::string path = scratch("found-rig.yaml").string();
  perform(explorer_, "export-rig " + path);
  const auto rig = read_rig(path);
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->mount.axis, Eigen::Vector3d::UnitX());
  EXPECT_NE(rig->mount.laser_in_motor_rpy_deg, Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

TEST_F(InARoom, OfASampleTheRigFoundIsNotUsed) {
  perform(explorer_, "solve-for offset,mount");
  perform(explorer_, "estimate");
  rest(explorer_);
  const std::string path = scratch("sample-rig.yaml").string();
  const auto done = explorer_.perform("use-rig " + path);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("sample"), std::string::npos) << done.error().message;
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(TheRigFound, IsUsedForTheMaps) {
  SimulationOptions tilted;
  tilted.scene = "room-1";
  tilted.duration_s = 4.5;
  tilted.mount_error_deg = {0, 3, -2};
  const std::string bag = scratch("tilted.bag").string(), rig = scratch("tilted-rig.yaml").string();
  ASSERT_TRUE(write_bag(*simulate(tilted, Job()), bag, Job()));
  Explorer explorer;
  perform(explorer, "open " + bag);
  rest(explorer);
  for (const char* line : {"solve-for offset,mount", "mount-prior 10 300", "offset-a 19", "estimate"}) {
    perform(explorer, line);
    rest(explorer);
  }
  EXPECT_NEAR(explorer.estimating.found()->rig->priors[kTurnU] * kDegPerRad, 10, 1e-9);
  const std::string found = observe(explorer, "found-rig").value();
  perform(explorer, "use-rig " + rig);
  rest(explorer);
  ASSERT_TRUE(explorer.loaded());
  EXPECT_NEAR(explorer.loaded()->recording.rig.mount.laser_in_motor_rpy_deg.y(), 3, 0.05);
  EXPECT_EQ(explorer.loaded()->choices.rig_file, rig);
  EXPECT_EQ(explorer.settings().offset_a_ms, 19);
  EXPECT_EQ(observe(explorer, "found-rig"), found);
  EXPECT_NE(command_line(explorer, 800, 600).find("--rig " + rig), std::string::npos);
}

TEST_F(InARoom, ARigThatWasNotSolvedForIsNotExported) {
  perform(explorer_, "estimate");
  rest(explorer_);
  EXPECT_EQ(observe(explorer_, "found-rig"), "");
  const auto done = explorer_.perform("export-rig " + scratch("none.yaml").string());
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("solve for"), std::string::npos) << done.error().message;
}

TEST(Failures, AFileThatIsNoSessionGivesAMessageAsARecordingDoes) {
  const std::string path = scratch("no-session.json").string();
  ASSERT_TRUE(write_file(path, "{}"));
  Explorer explorer;
  for (const std::string& file : {path, std::string("/nowhere/at-all.json")}) {
    perform(explorer, "open " + file);
    ASSERT_TRUE(explorer.messages.shown()) << file;
    EXPECT_NE(explorer.messages.shown()->text.find(file), std::string::npos)
        << explorer.messages.shown()->text;
    perform(explorer, "theme light");
  }
  std::filesystem::remove(path);
}

TEST(Failures, ASessionOpensRecordingsAndDoesNothingElse) {
  const std::string path = scratch("evil.json").string();
  Explorer explorer;
  for (const std::string& source :
       std::vector<std::string>{"save-session /tmp/x", "open " + path, "quit", "offset-a 19", "dance"}) {
    ASSERT_TRUE(write_file(path, R"({"schema": "sweepscope.session/1", "source": ")" + source + "\"}"));
    explorer.messages.dismiss();
    perform(explorer, "open " + path);
    ASSERT_TRUE(explorer.messages.shown()) << source;
    EXPECT_NE(explorer.messages.shown()->text.find("does not open a recording"), std::string::npos)
        << explorer.messages.shown()->text;
    EXPECT_FALSE(explorer.recording.is_opening());
    EXPECT_EQ(explorer.settings(), Settings());
  }
  std::filesystem::remove(path);
}

TEST(Failures, WhatCannotBeDoneNowIsRefused) {
  Explorer explorer;
  for (const char* line : {"estimate", "take-found", "fit-view", "export-curve a.csv", "export-cloud a a.pcd",
                           "export-rig a.yaml", "use-rig a.yaml", "export-report a"}) {
    const auto done = explorer.perform(line);
    ASSERT_FALSE(done) << line;
    EXPECT_EQ(done.error().code, ExitCode::kWrongUsage);
  }
}

}  // namespace
}  // namespace sweepscope::ui
