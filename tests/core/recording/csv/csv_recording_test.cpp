#include "core/recording/csv/csv_recording.hpp"

#include <fmt/format.h>

#include <algorithm>

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
  EXPECT_EQ(refusal(kScans, "when,angle_rad\n1,1\n"),
            "motor.csv: line 1 has no column stamp_s or receive_s; its columns are: when, angle_rad");
  EXPECT_EQ(refusal(kScans, "stamp_s,stamp_s,angle_rad\n"), "motor.csv: line 1 names column stamp_s twice");
  EXPECT_EQ(refusal(kScans, ""), "motor.csv: is empty");
  EXPECT_EQ(refusal("stamp_s,angle_min_rad,angle_increment_rad,ranges_m,intensities\n1,0,1,1 2,3\n", kMotor),
            "scans.csv: line 2, column intensities: \"1\" values, but ranges_m has 2");
}

TEST_F(CsvRecording, SemicolonsTabsAndDecimalCommasAreRead) {
  for (const char separator : {';', '\t'}) {
    std::string scans = "stamp_s,angle_min_rad,angle_increment_rad,ranges_m\n1|5,-0|5,0|25,1|5 2 3|25\n";
    std::string motor = "stamp_s,angle_deg\n1|25,90\n1|5,45|5\n";
    for (std::string* table : {&scans, &motor}) {
      std::ranges::replace(*table, ',', separator);
      std::ranges::replace(*table, '|', ',');
    }
    const auto raw = read(scans, motor);
    ASSERT_TRUE(raw) << raw.error().message;
    EXPECT_EQ(raw->lasers[0].scans[0].stamps.header_ns, 1'500'000'000);
    EXPECT_EQ(raw->lasers[0].scans[0].angle_min_rad, -0.5F);
    EXPECT_EQ(raw->lasers[0].ranges_m, (std::vector<float>{1.5F, 2, 3.25F}));
    EXPECT_EQ(raw->joints[0].stamps[0].header_ns, 1'250'000'000);
    EXPECT_DOUBLE_EQ(raw->joints[0].positions[1], 45.5 * M_PI / 180);
  }
  EXPECT_NE(refusal("stamp_s;angle_min_rad;angle_increment_rad;ranges_m\n1;0;1;1.5,2.5\n", kMotor)
                .find("\"1.5,2.5\" is not a number"),
            std::string::npos);
}

TEST_F(CsvRecording, CommentsAndEmptyLinesAreLeftOut) {
  const auto raw = read("# a log\n\n% of a scanner\n" + kScans + "# the end\n", "\xEF\xBB\xBF#\n" + kMotor);
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->lasers[0].scans.size(), 2U);
  EXPECT_EQ(refusal("# a log\n" + kScans + "1,0,1\n", kMotor),
            "scans.csv: line 5 has 3 cells, and line 2 names 5 columns");
}

TEST_F(CsvRecording, RangesInMillimetresAndAnglesInDegreesAreRead) {
  const auto raw =
      read("stamp_ms,angle_min_deg,angle_increment_deg,range_mm\n1500.25,-90,45,1500 2000 3250\n",
           "time_ns,angle_deg\n1500000001,90\n1600000001,45\n");
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->lasers[0].scans[0].stamps.header_ns, 1'500'250'000);
  EXPECT_FLOAT_EQ(raw->lasers[0].scans[0].angle_min_rad, static_cast<float>(-M_PI / 2));
  EXPECT_EQ(raw->lasers[0].ranges_m, (std::vector<float>{1.5F, 2, 3.25F}));
  EXPECT_EQ(raw->joints[0].stamps[0].header_ns, 1'500'000'001);
  EXPECT_TRUE(raw->warnings.empty());
}

TEST_F(CsvRecording, StampsInAnotherUnitAreNamedWithWhatToWrite) {
  EXPECT_EQ(
      refusal(kScans, "stamp_s,angle_rad\n1700000000123,1\n"),
      "motor.csv: line 2, column stamp_s: \"1700000000123\" is no time in seconds: by its size it counts "
      "ms; name the column stamp_ms");
  EXPECT_NE(refusal(kScans, "time,angle_rad\n1700000000123456789,1\n").find("name the column stamp_ns"),
            std::string::npos);
  std::string motor = "stamp_s,angle_rad\n";
  for (int i = 0; i < 20; ++i) motor += fmt::format("{},{}\n", 5000 + 10 * i, 0.1 * i);
  EXPECT_EQ(refusal(kScans, motor),
            "motor.csv: stamp_s advances by 10 s from sample to sample, as if it counted ms; name the column "
            "stamp_ms");
}

TEST_F(CsvRecording, ABeamPerLineMakesScansThatEndWhereTheAngleTurnsBack) {
  std::string scans = "time;angle_deg;range_mm\n";
  for (int i = 0; i < 10; ++i)
    if (i != 7) scans += fmt::format("1{},{};{};{}\n", i / 5, 2 * (i % 5), 90 * (i % 5), 1000 + i);
  const auto raw = read(scans, kMotor);
  ASSERT_TRUE(raw) << raw.error().message;
  ASSERT_EQ(raw->lasers[0].scans.size(), 2U);
  const RawScan& second = raw->lasers[0].scans[1];
  EXPECT_EQ(second.stamps.header_ns, 11'000'000'000);
  EXPECT_EQ(second.beams, 5U);
  EXPECT_FLOAT_EQ(second.angle_increment_rad, static_cast<float>(M_PI / 2));
  EXPECT_FLOAT_EQ(second.time_increment_s, 0.2F);
  EXPECT_FLOAT_EQ(raw->lasers[0].ranges_m[6], 1.006F);
  EXPECT_TRUE(std::isnan(raw->lasers[0].ranges_m[7]));
  EXPECT_TRUE(raw->warnings.empty());
}

TEST_F(CsvRecording, UnitsOfBeamsThatTheColumnsDoNotStateAreJudgedBySizeAndSaid) {
  std::string scans = "time,angle,distance\n";
  for (int i = 0; i < 20; ++i) scans += fmt::format("{},{},{}\n", 0.01 * i, 36 * (i % 10), 1500);
  const auto raw = read(scans, kMotor);
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->lasers[0].ranges_m[0], 1.5F);
  EXPECT_FLOAT_EQ(raw->lasers[0].scans[0].angle_increment_rad, static_cast<float>(M_PI / 5));
  ASSERT_EQ(raw->warnings.size(), 1U);
  EXPECT_EQ(
      raw->warnings[0],
      "scans.csv: by their sizes, angles are read as degrees and ranges as mm; state it in the columns' "
      "names (angle_deg, range_mm)");
}

TEST_F(CsvRecording, BeamsAtUnevenAnglesAreRefused) {
  EXPECT_NE(refusal("time,angle_deg,range_m\n0,0,1\n1,10,1\n2,20,1\n3,24,1\n4,36,1\n5,40,1\n", kMotor)
                .find("lines 2 to 7 are one scan, and its angles are not evenly spaced"),
            std::string::npos);
}

TEST_F(CsvRecording, WhatRostopicWritesIsRead) {
  const auto raw = read(
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angle_min,field.angle_max,"
      "field.angle_increment,field.time_increment,field.scan_time,field.range_min,field.range_max,"
      "field.ranges0,field.ranges1,field.ranges2,field.intensities0,field.intensities1,field.intensities2\n"
      "1700000000500000001,3,1700000000400000002,laser,-0.5,0.5,0.5,0.001,0.025,0.1,30,1,inf,nan,10,20,30\n",
      "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.name0,field.name1,field.position0,"
      "field.position1,field.velocity0,field.velocity1\n"
      "1700000000500000001,3,1700000000400000002,,wheel,roll,7,0.25,0,0\n");
  ASSERT_TRUE(raw) << raw.error().message;
  const RawScan& scan = raw->lasers[0].scans.at(0);
  EXPECT_EQ(scan.stamps.header_ns, 1'700'000'000'400'000'002);
  EXPECT_EQ(scan.stamps.receive_ns, 1'700'000'000'500'000'001);
  EXPECT_EQ(scan.angle_increment_rad, 0.5F);
  EXPECT_EQ(scan.scan_time_s, 0.025F);
  EXPECT_EQ(scan.beams, 3U);
  EXPECT_TRUE(std::isinf(raw->lasers[0].ranges_m[1]));
  EXPECT_EQ(raw->lasers[0].intensities, (std::vector<float>{10, 20, 30}));
  ASSERT_EQ(raw->joints.size(), 2U);
  EXPECT_EQ(raw->joints[1].joint, "roll");
  EXPECT_EQ(raw->joints[1].positions.at(0), 0.25);
  EXPECT_TRUE(raw->warnings.empty());
  const auto number = read(kScans, "%time,field.data\n1700000000500000001,90\n1700000000600000001,91\n");
  ASSERT_TRUE(number) << number.error().message;
  EXPECT_EQ(number->joints[0].source, JointSource::kNumber);
  EXPECT_EQ(number->joints[0].positions[1], 91);
  EXPECT_EQ(number->joints[0].stamps[0].receive_ns, 1'700'000'000'500'000'001);
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
