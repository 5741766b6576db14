#include "core/recording/rig/detect_rig.hpp"

#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/formats/recording_writer.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/recording/message_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"

namespace sweepscope {
namespace {

using test::kDegree;

struct Link {
  std::string parent, child;
  Eigen::Vector3d translation_m;
  Eigen::Quaterniond rotation;
};

std::string transform_bytes(double stamp_s, const std::vector<Link>& links) {
  test::MessageBytes message(test::MessageBytes::kCdr);
  message.number(static_cast<std::uint32_t>(links.size()));
  for (const Link& link : links) {
    const auto ns = static_cast<std::int64_t>(std::llround(stamp_s * 1e9));
    message
        .header(static_cast<std::uint32_t>(ns / 1'000'000'000),
                static_cast<std::uint32_t>(ns % 1'000'000'000), link.parent)
        .text(link.child);
    for (const double part : link.translation_m) message.number(part);
    for (const double part : link.rotation.coeffs()) message.number(part);
  }
  return message.bytes();
}

Eigen::Quaterniond turned(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized()));
}

/// The sample recording's streams as a ROS 2 bag, with the transforms of a rig.
class DetectRig : public testing::Test {
 protected:
  enum Topics { kScan = 1, kJoints, kStatic, kMoving };

  void write(const std::function<void(test::TestDatabase&)>& more, bool joints = true) const {
    test::TestDatabase database(folder_ / "rig.db3");
    database.topic(kScan, "/scan", "sensor_msgs/msg/LaserScan");
    database.topic(kJoints, "/joint_states", "sensor_msgs/msg/JointState");
    database.topic(kStatic, "/tf_static", "tf2_msgs/msg/TFMessage");
    database.topic(kMoving, "/tf", "tf2_msgs/msg/TFMessage");
    for (int i = 0; i < 80; ++i) {
      const double stamp_s = test::kStart_s + 1 + 0.025 * i;
      database.message(kScan, receive_ns(stamp_s + 0.03),
                       test::scan_bytes(test::MessageBytes::kCdr, seconds(stamp_s), nanoseconds(stamp_s),
                                        {1, 2, 3, 4, 5}));
    }
    for (int i = 0; joints && i < 220; ++i) {
      const double stamp_s = test::kStart_s + 0.9 + 0.01 * i;
      database.message(kJoints, receive_ns(stamp_s + 0.001),
                       test::joint_bytes(test::MessageBytes::kCdr, seconds(stamp_s), nanoseconds(stamp_s),
                                         {"tilt_motor"}, {angle_rad(stamp_s)}));
    }
    more(database);
  }
  static double angle_rad(double stamp_s) { return test::sample_angle_rad(stamp_s - test::kStart_s); }
  static std::int64_t receive_ns(double s) { return std::llround(s * 1e9); }
  static std::uint32_t seconds(double s) { return static_cast<std::uint32_t>(receive_ns(s) / 1'000'000'000); }
  static std::uint32_t nanoseconds(double s) {
    return static_cast<std::uint32_t>(receive_ns(s) % 1'000'000'000);
  }
  DetectedRig detected(const ReadOptions& options = {}) const {
    const auto found = detect_rig(folder_ / "rig.db3", options, Job());
    EXPECT_TRUE(found) << found.error().message;
    return found ? *found : DetectedRig();
  }
  /// The frame that turns in "mast", by the joint's angle about `axis` of the mast, after `rest`.
  static void turn(test::TestDatabase& database, const Eigen::Vector3d& axis,
                   const Eigen::Quaterniond& rest) {
    for (int i = 0; i < 200; ++i) {
      const double stamp_s = test::kStart_s + 1 + 0.01 * i;
      database.message(
          kMoving, receive_ns(stamp_s + 0.001),
          transform_bytes(stamp_s,
                          {{"mast", "plate", {0, 0, 1.2}, turned(angle_rad(stamp_s), axis) * rest}}));
    }
  }

  test::ScratchFolder folder_;
};

void expect_same(const Rig& left, const Rig& right) {
  EXPECT_EQ(left.laser.topic, right.laser.topic);
  EXPECT_EQ(left.laser.stamp, right.laser.stamp);
  EXPECT_EQ(left.laser.stamp_at, right.laser.stamp_at);
  EXPECT_EQ(left.laser.time_increment_s, right.laser.time_increment_s);
  EXPECT_EQ(left.motor.topic, right.motor.topic);
  EXPECT_EQ(left.motor.joint, right.motor.joint);
  EXPECT_EQ(left.motor.stamp, right.motor.stamp);
  EXPECT_EQ(left.motor.scale, right.motor.scale);
  EXPECT_EQ(left.motor.zero_deg, right.motor.zero_deg);
  EXPECT_LT((left.mount.axis - right.mount.axis).norm(), 1e-14);
  EXPECT_EQ(left.mount.laser_in_motor_xyz_m, right.mount.laser_in_motor_xyz_m);
  EXPECT_EQ(left.mount.laser_in_motor_rpy_deg, right.mount.laser_in_motor_rpy_deg);
}

TEST_F(DetectRig, TheFileReadsBackAsTheSameSettings) {
  write([](test::TestDatabase& database) {
    database.message(kStatic, 1,
                     transform_bytes(0, {{"plate", "laser", {0.018, 0.04, 0.06}, turned(0.3, {1, 2, 3})}}));
    turn(database, {0.1, 0.9, -0.2}, turned(0.4, {1, 0, 0}));
  });
  const DetectedRig rig = detected();
  const std::string text = rig_file_text(rig);
  test::write_file(folder_ / "rig.yaml", text);
  const auto back = read_rig(folder_ / "rig.yaml");
  ASSERT_TRUE(back) << back.error().message << "\n" << text;
  expect_same(*back, rig.rig);
  EXPECT_TRUE(rig.mount_found);
  EXPECT_EQ(back->laser.topic, "/scan");
  EXPECT_EQ(back->motor.joint, "tilt_motor");
}

TEST_F(DetectRig, TransformsGiveTheMountWhateverTheFramesRestIs) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.1, 0.9, -0.2).normalized(), offset(0.018, 0.04, 0.06);
  const Eigen::Quaterniond rest = turned(0.4, {1, 0, 0}), laser = turned(0.3, {1, 2, 3});
  write([&](test::TestDatabase& database) {
    database.message(kStatic, 1,
                     transform_bytes(0, {{"plate", "bracket", {0, 0, 0.02}, turned(0.1, {0, 0, 1})},
                                         {"bracket", "laser", offset, laser}}));
    turn(database, axis, rest);
  });
  const Rig::Mount mount = detected().rig.mount;
  EXPECT_LT((mount.axis - axis).norm(), 1e-5);
  // Where a point of the laser lies in the mast's axes: once by the transforms, once by the rig.
  const Eigen::Vector3d p_in_laser(2, -1, 0);
  const Eigen::Vector3d p_in_plate =
      turned(0.1, {0, 0, 1}) * (laser * p_in_laser + offset) + Eigen::Vector3d(0, 0, 0.02);
  const Kinematics kinematics(mount);
  for (const double angle : {-0.7, 0.0, 1.0}) {
    const Eigen::Vector3d expected = turned(angle, axis) * rest * p_in_plate;
    const double azimuth = std::atan2(p_in_laser.y(), p_in_laser.x());
    const Eigen::Vector3d p_in_motor = kinematics.point_in_motor(p_in_laser.norm(), azimuth);
    EXPECT_LT((kinematics.base_from_motor(p_in_motor, angle) - expected).norm(), 5e-5) << angle;
  }
}

TEST_F(DetectRig, TheAxisPointsSoThatTheMotorsAngleGrows) {
  write([](test::TestDatabase& database) {
    database.message(kStatic, 1, transform_bytes(0, {{"/plate", "/laser", {0, 0, 0}, turned(0, {0, 0, 1})}}));
    turn(database, {0, -1, 0}, turned(0, {0, 0, 1}));
  });
  EXPECT_LT((detected().rig.mount.axis - Eigen::Vector3d(0, -1, 0)).norm(), 1e-6);
}

TEST_F(DetectRig, WithoutJointsTheTurningFrameIsTheMotor) {
  write(
      [](test::TestDatabase& database) {
        database.message(kStatic, 1,
                         transform_bytes(0, {{"plate", "laser", {0, 0, 0}, turned(0, {0, 0, 1})}}));
        turn(database, {0, 1, 0}, turned(0, {0, 0, 1}));
      },
      false);
  const DetectedRig rig = detected();
  EXPECT_EQ(rig.rig.motor.joint, "plate");
  EXPECT_EQ(rig.rig.motor.topic, "/tf");
  test::write_file(folder_ / "rig.yaml", rig_file_text(rig));
  ReadOptions options;
  options.rig = *read_rig(folder_ / "rig.yaml");
  const auto recording = read_recording(folder_ / "rig.db3", options, Job());
  ASSERT_TRUE(recording) << recording.error().message;
  // The angle about the axis that was found, of either sign.
  const auto [least, most] = std::ranges::minmax(recording->motor.angle_rad);
  EXPECT_NEAR(most - least, 2, 0.05);
  EXPECT_NEAR(std::abs(rig.rig.mount.axis.y()), 1, 1e-6);
}

TEST_F(DetectRig, OnlyStaticTransformsGiveThePoseAndNotTheAxis) {
  write([](test::TestDatabase& database) {
    database.message(kStatic, 1,
                     transform_bytes(0, {{"plate", "laser", {0.01, 0, 0.05}, turned(0, {0, 0, 1})}}));
  });
  const DetectedRig rig = detected();
  EXPECT_EQ(rig.rig.mount.laser_in_motor_xyz_m, Eigen::Vector3d(0.01, 0, 0.05));
  EXPECT_EQ(rig.rig.mount.axis, Eigen::Vector3d::UnitX());
  EXPECT_NE(rig.mount_note.find("the axis is not known"), std::string::npos) << rig.mount_note;
}

TEST_F(DetectRig, TransformsThatDoNotFollowTheMotorAreNotUsed) {
  write([](test::TestDatabase& database) {
    database.message(kStatic, 1,
                     transform_bytes(0, {{"plate", "laser", {0.01, 0, 0.05}, turned(0, {0, 0, 1})}}));
    for (int i = 0; i < 20; ++i)  // once long before the motor was recorded, once after
      database.message(kMoving, 1 + i,
                       transform_bytes(10 + i, {{"mast", "plate", {0, 0, 1}, turned(0.1 * i, {0, 1, 0})}}));
  });
  const DetectedRig rig = detected();
  EXPECT_FALSE(rig.mount_found);
  EXPECT_EQ(rig.rig.mount.laser_in_motor_xyz_m, Eigen::Vector3d::Zero());
  EXPECT_NE(rig.mount_note.find("do not fit the motor's angles"), std::string::npos) << rig.mount_note;
}

TEST_F(DetectRig, ATransformStampedJustBeforeTheFirstSampleIsUsed) {
  const Eigen::Vector3d axis(0, 1, 0);
  write([&](test::TestDatabase& database) {
    for (int i = 0; i < 100; ++i) {
      const double stamp_s = test::kStart_s + 0.885 + 0.01 * i;  // the motor's samples begin at 0.9
      const Eigen::Quaterniond rotation = turned(angle_rad(stamp_s), axis);
      database.message(kMoving, receive_ns(stamp_s),
                       transform_bytes(stamp_s, {{"mast", "laser", {0, 0, 1}, rotation}}));
    }
  });
  const DetectedRig rig = detected();
  EXPECT_TRUE(rig.mount_found) << rig.mount_note;
  EXPECT_LT((rig.rig.mount.axis - axis).norm(), 1e-6);
  EXPECT_LT(rig.rig.mount.laser_in_motor_rpy_deg.norm(), 1e-3);
}

TEST_F(DetectRig, AScanReceivedTooEarlyWasStampedAtItsEnd) {
  write([](test::TestDatabase&) {});
  EXPECT_EQ(detected().rig.laser.stamp_at, StampAt::kFirstBeam);  // received 30 ms after, and 4 ms long
  const Simulation& room = test::simulated("room-1", 0.0243, 2.5);
  ASSERT_TRUE(write_bag(room, folder_ / "room.bag", Job()));
  auto raw = *read_raw_recording(folder_ / "room.bag", Rig(), Job());
  const double scan_s = room.recording.scans[0].last_beam_s() - room.recording.scans[0].first_beam_s;
  for (RawScan& scan : raw.lasers[0].scans) scan.stamps.header_ns += std::llround(scan_s * 1e9);
  ASSERT_TRUE(write_recording(raw.lasers[0], raw.joints[0], RecordingFormat::kMcap, "none",
                              folder_ / "end.mcap", Job()));
  EXPECT_EQ(detect_rig(folder_ / "room.bag", {}, Job())->rig.laser.stamp_at, StampAt::kFirstBeam);
  EXPECT_EQ(detect_rig(folder_ / "end.mcap", {}, Job())->rig.laser.stamp_at, StampAt::kLastBeam);
}

TEST_F(DetectRig, ARigGivenIsKept) {
  write([](test::TestDatabase& database) {
    database.message(kStatic, 1,
                     transform_bytes(0, {{"plate", "laser", {0.01, 0, 0.05}, turned(0, {0, 0, 1})}}));
  });
  ReadOptions options;
  options.rig.emplace();
  options.rig->mount.axis = Eigen::Vector3d::UnitZ();
  options.rig->laser.stamp_at = StampAt::kArrival;
  options.rig->motor.scale = -1;
  const Rig rig = detected(options).rig;
  EXPECT_EQ(rig.mount.axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(rig.mount.laser_in_motor_xyz_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(rig.laser.stamp_at, StampAt::kArrival);
  EXPECT_EQ(rig.motor.scale, -1);
}

TEST_F(DetectRig, NamesThatWouldBeYamlAreQuoted) {
  DetectedRig rig;
  for (const std::string name : {"null", "12", "a: b", "x # y", "\"q\"", "\\", "[1]", "~", "tab\there"}) {
    rig.rig.motor.joint = rig.rig.motor.topic = rig.rig.laser.topic = name;
    rig.recording = rig.motor_note = "line\nbreak";
    test::write_file(folder_ / "rig.yaml", rig_file_text(rig));
    const auto back = read_rig(folder_ / "rig.yaml");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->motor.joint, name);
    EXPECT_EQ(back->laser.topic, name);
  }
}

/// One recording, stamped at three places of its scans.
TEST_F(DetectRig, StampsAtTheFirstOrTheLastBeamGiveTheSameOffsetAndArrivalsOneLaterByTheDelay) {
  constexpr double kLate_s = 0.002;  // from the last beam to the arrival
  const Simulation& room = test::simulated("room-1", 0.0243, 2.5);
  ASSERT_TRUE(write_bag(room, folder_ / "room.bag", Job()));
  const auto offset_ms = [&](StampAt stamp_at, double later_s) {
    auto raw = *read_raw_recording(folder_ / "room.bag", Rig(), Job());
    for (RawScan& scan : raw.lasers[0].scans) scan.stamps.header_ns += std::llround(later_s * 1e9);
    const std::filesystem::path file = folder_ / "stamped.mcap";
    EXPECT_TRUE(write_recording(raw.lasers[0], raw.joints[0], RecordingFormat::kMcap, "none", file, Job()));
    ReadOptions options;
    options.rig.emplace();
    options.rig->laser.stamp_at = stamp_at;
    EstimateOptions how;
    how.method = Method::kDirect;
    const auto found = estimate(*read_recording(file, options, Job()), how, Job());
    EXPECT_TRUE(found && found->offset_s);
    return found && found->offset_s ? *found->offset_s * 1e3 : 0.0;
  };
  const double scan_s = room.recording.scans[0].last_beam_s() - room.recording.scans[0].first_beam_s;
  const double at_first_ms = offset_ms(StampAt::kFirstBeam, 0);
  EXPECT_NEAR(at_first_ms, 24.3, 0.1);
  EXPECT_NEAR(offset_ms(StampAt::kLastBeam, scan_s), at_first_ms, 1e-4);
  EXPECT_NEAR(offset_ms(StampAt::kArrival, scan_s + kLate_s), at_first_ms - kLate_s * 1e3, 0.05);
  // The same stamps taken for the first beam's are wrong by the length of a scan.
  EXPECT_NEAR(offset_ms(StampAt::kFirstBeam, scan_s), at_first_ms - scan_s * 1e3, 0.5);
}

}  // namespace
}  // namespace sweepscope
