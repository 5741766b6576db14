#include "core/recording/rig.hpp"

#include "tests/core/recording/test_bag.hpp"

namespace sweepscope {
namespace {

Result<Rig> read_text(const std::string& text) {
  const test::ScratchFolder folder;
  test::write_file(folder / "rig.yaml", text);
  return read_rig(folder / "rig.yaml");
}

/// The refusal of a text, from the place on: "3:5: ...".
std::string refusal(const std::string& text) {
  const auto rig = read_text(text);
  if (rig) return "accepted";
  EXPECT_EQ(rig.error().code, ExitCode::kUnreadableInput);
  const auto name = rig.error().message.find("rig.yaml:");
  return name == std::string::npos ? rig.error().message : rig.error().message.substr(name + 9);
}

TEST(Rig, ReadsEveryKey) {
  const auto rig = read_text(
      "laser: {topic: /scan, stamp: receive, stamp_at: last_beam, time_increment_s: 1.736e-5}\n"
      "motor: {topic: /joints, joint: roll, stamp: header, scale: -0.5, zero_deg: 3}\n"
      "mount:\n"
      "  axis: [0, 0, 2]\n"
      "  laser_in_motor: {xyz_m: [1, 2, 3], rpy_deg: [4, 5, 6]}\n");
  ASSERT_TRUE(rig) << rig.error().message;
  EXPECT_EQ(rig->laser.topic, "/scan");
  EXPECT_EQ(rig->laser.stamp, StampSource::kReceive);
  EXPECT_EQ(rig->laser.stamp_at, StampAt::kLastBeam);
  EXPECT_EQ(rig->laser.time_increment_s, 1.736e-5);
  EXPECT_EQ(rig->motor.topic, "/joints");
  EXPECT_EQ(rig->motor.joint, "roll");
  EXPECT_EQ(rig->motor.stamp, StampSource::kHeader);
  EXPECT_EQ(rig->motor.scale, -0.5);
  EXPECT_EQ(rig->motor.zero_deg, 3);
  EXPECT_EQ(rig->mount.axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(rig->mount.laser_in_motor_xyz_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(rig->mount.laser_in_motor_rpy_deg, Eigen::Vector3d(4, 5, 6));
}

TEST(Rig, LeavesOutWhatIsToBeDetected) {
  for (const auto& [unit, rad] :
       {std::pair{"rad", 1.0}, {"deg", std::numbers::pi / 180}, {"turns", 2 * std::numbers::pi}})
    EXPECT_NEAR(read_text(fmt::format("motor: {{scale: 2, unit: {}}}\n", unit))->motor.rad_per_value(),
                2 * rad, 1e-12);
  for (const double increment_s : {0.0, -1.736e-5})
    EXPECT_EQ(
        read_text(fmt::format("laser: {{time_increment_s: {}}}\n", increment_s))->laser.time_increment_s,
        increment_s);
  const auto rig = read_text("motor: {scale: 2}\n");
  ASSERT_TRUE(rig);
  EXPECT_FALSE(rig->laser.topic);
  EXPECT_FALSE(rig->motor.joint);
  EXPECT_EQ(rig->laser.stamp_at, StampAt::kFirstBeam);
  EXPECT_EQ(rig->mount.axis, Eigen::Vector3d::UnitX());
}

TEST(Rig, KnowsWhetherItStatesAMount) {
  EXPECT_FALSE(read_text("motor: {scale: 2}\n")->states_mount());
  EXPECT_TRUE(read_text("mount: {axis: [1, 0, 0]}\n")->states_mount());
  EXPECT_TRUE(read_text("mount: {axis: [0, 1, 0]}\n")->states_mount());
}

TEST(Rig, RefusesUnknownKeysWithTheirPlace) {
  EXPECT_EQ(
      refusal("laser: {topic: /scan}\nmotor: {joint: a, sclae: 2}\n"),
      "2:19: unknown key \"sclae\" in motor; known are: field, index, joint, profile, scale, stamp, topic, unit, zero_deg");
  EXPECT_EQ(refusal("lidar: {}\n"),
            "1:1: unknown key \"lidar\" in the rig file; known are: encoder, imu, laser, motor, "
            "mount, odometry, play_deg");
}

TEST(Rig, RefusesImpossibleValuesWithTheirPlace) {
  EXPECT_EQ(refusal("motor: {scale: 0}"), "1:16: motor.scale must not be 0");
  EXPECT_EQ(refusal("motor: {zero_deg: .nan}"), "1:19: motor.zero_deg must be a finite number");
  EXPECT_EQ(refusal("motor: {scale: two}"), "1:16: motor.scale must be a finite number");
  EXPECT_EQ(refusal("laser: {stamp: haeder}"), "1:16: laser.stamp must be one of: header, receive");
  EXPECT_EQ(refusal("laser: {stamp_at: middle}"),
            "1:19: laser.stamp_at must be one of: arrival, first_beam, last_beam");
  EXPECT_EQ(refusal("laser: {time_increment_s: -1}"),
            "1:27: laser.time_increment_s must be more than -1 and less than 1 s");
  EXPECT_EQ(refusal("laser: {topic: [a]}"), "1:16: laser.topic must be a name");
  EXPECT_EQ(refusal("mount:\n  axis: [0, 0, 0]\n"), "2:9: mount.axis must have a direction");
  EXPECT_EQ(refusal("mount: {axis: [1, 0]}"), "1:15: mount.axis must be three numbers");
  EXPECT_EQ(refusal("mount: {laser_in_motor: {xyz_m: [0, x, 0]}}"),
            "1:37: mount.laser_in_motor.xyz_m must be a finite number");
  EXPECT_EQ(refusal("play_deg: -0.1"), "1:11: play_deg must be from 0 to 10");
  EXPECT_EQ(refusal("encoder: {amplitude_deg: 11}"), "1:26: encoder.amplitude_deg must be from 0 to 10");
  EXPECT_EQ(refusal("- laser\n"), "1:1: the rig file must be a map of keys to values");
}

TEST(Rig, RefusesAKeyThatComesTwice) {
  EXPECT_EQ(refusal("motor: {scale: 2, scale: 3}"), "1:19: duplicate key \"scale\" in motor");
}

TEST(Rig, RefusesWhatIsNoYamlWithThePlace) {
  EXPECT_EQ(refusal("laser: {topic: /scan\nmotor: [").substr(0, 2), "2:");
  EXPECT_NE(refusal(std::string(100'000, '[')), "accepted");
  EXPECT_NE(refusal(std::string("\0\xFF\x01", 3)), "accepted");
}

TEST(Rig, RefusesAFileThatIsNotThereOrTooLong) {
  const auto missing = read_rig("/nowhere/rig.yaml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "/nowhere/rig.yaml: no such file");
  EXPECT_NE(refusal(std::string((1U << 20) + 1, ' ')).find("too many for a rig file"), std::string::npos);
}

TEST(Rig, ThoseThatAreKeptAreSound) {
  const std::filesystem::path folder = std::filesystem::path(SWEEPSCOPE_SOURCE_DIR) / "assets/rigs";
  const auto paper = read_rig(folder / "utm30lx_mx64r.yaml");
  ASSERT_TRUE(paper) << paper.error().message;
  EXPECT_EQ(paper->mount.axis, Eigen::Vector3d::UnitX());
  EXPECT_FALSE(paper->laser.topic);
  const auto tilt = read_rig(folder / "guardian_tilt.yaml");
  ASSERT_TRUE(tilt) << tilt.error().message;
  EXPECT_EQ(tilt->mount.axis, Eigen::Vector3d::UnitY());
  EXPECT_EQ(tilt->mount.laser_in_motor_xyz_m, Eigen::Vector3d(0.018, 0.040, 0.060));
  EXPECT_EQ(tilt->motor.joint, "laser_tilt_joint");
}

}  // namespace
}  // namespace sweepscope
