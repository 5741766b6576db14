#include "core/recording/csv/csv_recording.hpp"

#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

const std::string kScans =
    "stamp_s,angle_min_rad,angle_increment_rad,time_increment_s,ranges_m\n"
    "10.000000001,-0.5,0.5,0.001,1 2 inf\n"
    "10.025,-0.5,0.5,0.001,1.5 nan 3\n";
const std::string kMotor = "stamp_s,angle_rad\n9.99,0\n10.1,0.25\n";

class CsvRecording : public testing::Test {
 protected:
  Result<RawRecording> read(const std::string& scans, const std::string& motor, const Rig& rig = {}) const {
    std::filesystem::create_directories(folder_ / "rec");
    test::write_file(folder_ / "rec/scans.csv", scans);
    test::write_file(folder_ / "rec/motor.csv", motor);
    return read_raw_recording(folder_ / "rec", rig, Job());
  }
  /// The refusal, from the file's name on.
  std::string refusal(const std::string& scans, const std::string& motor) const {
    const auto raw = read(scans, motor);
    if (raw) return "accepted";
    EXPECT_EQ(raw.error().code, ExitCode::kUnreadableInput);
    return raw.error().message.substr(raw.error().message.find("rec") + 4);
  }

  test::ScratchFolder folder_;
};

TEST_F(CsvRecording, ReadsStampsToTheNanosecondAndRangesAsTheyAre) {
  const auto raw = read(kScans, kMotor);
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->name, "rec");
  ASSERT_EQ(raw->lasers.size(), 1U);
  const RawLaser& laser = raw->lasers[0];
  EXPECT_EQ(laser.topic, "/scan");
  ASSERT_EQ(laser.scans.size(), 2U);
  EXPECT_EQ(laser.scans[0].stamps.header_ns, 10'000'000'001);
  EXPECT_EQ(laser.scans[0].stamps.receive_ns, 0);
  EXPECT_EQ(laser.scans[1].first_range, 3U);
  EXPECT_EQ(laser.scans[1].time_increment_s, 0.001F);
  EXPECT_TRUE(std::isinf(laser.ranges_m[2]));
  EXPECT_TRUE(std::isnan(laser.ranges_m[4]));
  EXPECT_FALSE(laser.has_intensities);
  ASSERT_EQ(raw->joints.size(), 1U);
  EXPECT_EQ(raw->joints[0].joint, "motor");
  EXPECT_EQ(raw->joints[0].stamps[0].header_ns, 9'990'000'000);
  EXPECT_EQ(raw->joints[0].positions, (std::vector<double>{0, 0.25}));
  EXPECT_TRUE(raw->warnings.empty());
}

TEST_F(CsvRecording, TakesWhatSpreadsheetsAndOtherSystemsWrite) {
  const auto raw = read(
      "\xEF\xBB\xBF\"ranges_m\",intensities, angle_min_rad ,angle_increment_rad,receive_s,topic,note\r\n"
      "1  2,3 4,0,1,0.5,\"a,\"\"b\"\"\",x\r\n\r\n3 4,5 6,0,1,1,\"a,\"\"b\"\"\",\r\n",
      "position,receive_s,joint\n90,1,tilt\n45,2,pan\n");
  ASSERT_TRUE(raw) << raw.error().message;
  ASSERT_EQ(raw->lasers.size(), 1U);
  EXPECT_EQ(raw->lasers[0].topic, "a,\"b\"");
  EXPECT_EQ(raw->lasers[0].scans[0].stamps.receive_ns, 500'000'000);
  EXPECT_EQ(raw->lasers[0].intensities, (std::vector<float>{3, 4, 5, 6}));
  ASSERT_EQ(raw->joints.size(), 2U);
  EXPECT_EQ(raw->joints[1].joint, "pan");
  EXPECT_EQ(raw->joints[0].source, JointSource::kNumber);
  ASSERT_EQ(raw->warnings.size(), 1U);
  EXPECT_EQ(raw->warnings[0], "scans.csv has unknown columns, which were ignored: note");
}

TEST_F(CsvRecording, DegreesBecomeRadians) {
  const auto raw = read(kScans, "stamp_s,angle_deg\n1,90\n2,-180\n");
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_DOUBLE_EQ(raw->joints[0].positions[0], M_PI / 2);
  EXPECT_DOUBLE_EQ(raw->joints[0].positions[1], -M_PI);
}

TEST_F(CsvRecording, TheRigLeavesOutOtherTopicsAndJoints) {
  Rig rig;
  rig.laser.topic = "/other";
  rig.motor.joint = "tilt";
  const auto raw = read(kScans, "stamp_s,angle_rad,joint\n1,1,tilt\n2,2,pan\n", rig);
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_TRUE(raw->lasers[0].scans.empty());
  EXPECT_EQ(raw->topics[0].messages, 2U);
  EXPECT_EQ(raw->joints[0].positions.size(), 1U);
  EXPECT_EQ(raw->joints[1].positions.size(), 0U);
}

TEST_F(CsvRecording, WhatIsWrongIsNamedWithItsPlace) {
  EXPECT_EQ(refusal(kScans + "1,0,1,0.001,1 x 2\n", kMotor),
            "scans.csv: line 4, column ranges_m: \"x\" is not a number");
  EXPECT_EQ(refusal(kScans + "-1,0,1,0,1\n", kMotor),
            "scans.csv: line 4, column stamp_s: \"-1\" is not a time in decimal seconds (0 or more)");
  EXPECT_EQ(refusal(kScans + "1e9,0,1,0,1\n", kMotor),
            "scans.csv: line 4, column stamp_s: \"1e9\" is not a time in decimal seconds (0 or more)");
  EXPECT_EQ(refusal(kScans + "99999999999,0,1,0,1\n", kMotor),
            "scans.csv: line 4, column stamp_s: \"99999999999\" is not a time in decimal seconds (0 or "
            "more)");
  EXPECT_EQ(refusal(kScans + "1,0,1,1\n", kMotor),
            "scans.csv: line 4 has 4 cells, and line 1 names 5 columns");
  EXPECT_EQ(refusal(kScans, "stamp_s,angle_rad\n1,\n"),
            "motor.csv: line 2, column angle_rad: \"\" is not a number");
  EXPECT_EQ(
      refusal(kScans, "stamp_s,angle\n1,1\n"),
      "motor.csv: line 1 has no column angle_rad or angle_deg or position; its columns are: stamp_s, angle");
  EXPECT_EQ(refusal(kScans, "time,angle_rad\n1,1\n"),
            "motor.csv: line 1 has no column stamp_s or receive_s; its columns are: time, angle_rad");
  EXPECT_EQ(refusal(kScans, "stamp_s,stamp_s,angle_rad\n"), "motor.csv: line 1 names column stamp_s twice");
  EXPECT_EQ(refusal(kScans, ""), "motor.csv: is empty");
  EXPECT_EQ(refusal("stamp_s,angle_min_rad,angle_increment_rad,ranges_m,intensities\n1,0,1,1 2,3\n", kMotor),
            "scans.csv: line 2, column intensities: \"1\" values, but ranges_m has 2");
}

TEST_F(CsvRecording, ALastLineThatWasCutShortIsLeftAside) {
  for (const std::string cut : {"10.05,-0.5,0.5", "10.05,-0.5,0.5,0.001,1 2 i"}) {
    const auto raw = read(kScans + cut, kMotor);
    ASSERT_TRUE(raw) << raw.error().message;
    EXPECT_EQ(raw->lasers[0].scans.size(), 2U);
    EXPECT_EQ(raw->lasers[0].ranges_m.size(), 6U);
    ASSERT_EQ(raw->warnings.size(), 1U);
    EXPECT_EQ(raw->warnings[0], "scans.csv is cut short in line 4, which was ignored");
  }
}

TEST_F(CsvRecording, AFolderIsRefusedByWhatItLacks) {
  std::filesystem::create_directories(folder_ / "rec");
  const auto refused = [&] { return read_raw_recording(folder_ / "rec", Rig(), Job()).error().message; };
  EXPECT_NE(refused().find("rec: is a folder without a recording"), std::string::npos);
  test::write_file(folder_ / "rec/motor.csv", kMotor);
  EXPECT_NE(refused().find("rec: is a folder with motor.csv and without scans.csv"), std::string::npos);
}

TEST_F(CsvRecording, IsReadBackAsItWasWritten) {
  RawLaser laser;
  laser.topic = "odd, \"name\"";
  laser.ranges_m = {0.1F, 1.0F / 3, INFINITY, 1e-30F, 16777217.0F};
  laser.intensities = {0, 1, 2, 3, 4.7F};
  laser.scans = {{{1'489'900'000'123'456'789, 5}, 0.1F, 0.4F, 0.1F, 1.736e-5F, 0.025F, 0.1F, 30, 0, 3},
                 {{1, 0}, 0.1F, 0.2F, 0.1F, 0, 0, 0, 0, 3, 2}};
  RawJoint joint{"/servo", "roll", JointSource::kNumber, {{0, 7}, {1'500'000'000, 0}}, {M_PI, -1.0 / 3}};
  ASSERT_TRUE(write_csv_recording(laser, joint, folder_ / "new/rec", Job()));
  const auto raw = read_raw_recording(folder_ / "new/rec", Rig(), Job());
  ASSERT_TRUE(raw) << raw.error().message;
  ASSERT_EQ(raw->lasers.size(), 1U);
  EXPECT_EQ(raw->lasers[0].topic, laser.topic);
  EXPECT_EQ(raw->lasers[0].ranges_m, laser.ranges_m);
  EXPECT_EQ(raw->lasers[0].intensities, laser.intensities);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(raw->lasers[0].scans[i].stamps.header_ns, laser.scans[i].stamps.header_ns);
    EXPECT_EQ(raw->lasers[0].scans[i].stamps.receive_ns, laser.scans[i].stamps.receive_ns);
    EXPECT_EQ(raw->lasers[0].scans[i].time_increment_s, laser.scans[i].time_increment_s);
    EXPECT_EQ(raw->lasers[0].scans[i].range_max_m, laser.scans[i].range_max_m);
    EXPECT_EQ(raw->joints[0].stamps[i].header_ns, joint.stamps[i].header_ns);
    EXPECT_EQ(raw->joints[0].stamps[i].receive_ns, joint.stamps[i].receive_ns);
  }
  EXPECT_EQ(raw->joints[0].positions, joint.positions);
  EXPECT_EQ(raw->joints[0].joint, "roll");
  EXPECT_EQ(raw->joints[0].source, JointSource::kNumber);
  EXPECT_TRUE(raw->warnings.empty());
}

TEST_F(CsvRecording, AnInterruptedWriteLeavesNoTables) {
  RawLaser laser;
  laser.scans.resize(3);
  Job job;
  job.cancel();
  const auto written = write_csv_recording(laser, RawJoint(), folder_ / "rec", job);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kInterrupted);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "rec"));
}

}  // namespace
}  // namespace sweepscope
