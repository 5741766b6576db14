#include "core/apply/rig_snippet.hpp"

#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <sstream>

#include "core/geometry/kinematics.hpp"

namespace sweepscope {
namespace {

/// Portable random numbers in [-1, 1].
class Random {
 public:
  double next() { return double(engine_() >> 11) * 0x1p-52 - 1; }
  Eigen::Vector3d vector() { return {next(), next(), next()}; }

 private:
  std::mt19937_64 engine_{7};
};

/// The numbers in the first match's first group.
std::vector<double> numbers_in(const std::string& text, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(pattern))) return {};
  std::string found = match[1];
  for (char& c : found)
    if (c == ',' || c == '\n') c = ' ';
  std::istringstream stream(found);
  std::vector<double> numbers;
  double number = 0;
  while (stream >> number) numbers.push_back(number);
  return numbers;
}

Eigen::Vector3d vector_in(const std::string& text, const std::string& pattern) {
  const auto numbers = numbers_in(text, pattern);
  EXPECT_EQ(numbers.size(), 3U) << pattern << "\n" << text;
  return numbers.size() == 3 ? Eigen::Vector3d(numbers[0], numbers[1], numbers[2])
                             : Eigen::Vector3d(Eigen::Vector3d::Constant(NAN));
}

/// As ROS makes rotations of roll, pitch and yaw about fixed axes.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rpy_rad) {
  return (Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

RigSnippet random_snippet(Random& random) {
  RigSnippet snippet;
  snippet.source = "a.bag";
  snippet.offset.offset_s = 0.0241 * random.next();
  snippet.rig.mount.axis = random.vector().normalized();
  snippet.rig.mount.laser_in_motor_xyz_m = random.vector();
  snippet.rig.mount.laser_in_motor_rpy_deg = 180 * random.vector();
  snippet.rig.motor.zero_deg = 90 * random.next();
  snippet.rig.motor.scale = random.next() < 0 ? -1 : 1;
  snippet.rig.motor.joint = "tilt_joint";
  snippet.rig.laser.topic = "/tilt_scan";
  return snippet;
}

/// Where sweepscope places a point of the laser's frame, for a position of the joint as it was recorded.
Eigen::Vector3d placed(const Rig& rig, const Eigen::Vector3d& p_in_laser, double position) {
  const Kinematics kinematics(rig.mount);
  const double angle_rad = rig.motor.scale * position - rig.motor.zero_deg * kRadPerDeg;
  return kinematics.base_from_motor(kinematics.point_in_motor(p_in_laser.norm(), p_in_laser.normalized()),
                                    angle_rad);
}

constexpr double kDigits = 2e-8;  // numbers are written to 1e-9, and positions are within 2 m

TEST(RpyOfRotation, GivesTheRotationBack) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d r = rotation_of(M_PI * random.vector());
    EXPECT_LT((rotation_of(rpy_rad_of(Eigen::Quaterniond(r))) - r).norm(), 1e-9);
  }
  for (const double pitch : {M_PI_2, -M_PI_2})
    for (const double roll : {-2.0, 0.0, 1.0}) {
      const Eigen::Matrix3d r = rotation_of({roll, pitch, 0.7});
      EXPECT_LT((rotation_of(rpy_rad_of(Eigen::Quaterniond(r))) - r).norm(), 1e-6) << "gimbal lock";
    }
}

TEST(RigSnippet, AUrdfPlacesPointsAsSweepscopeDoes) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const RigSnippet snippet = random_snippet(random);
    const std::string text = rig_snippet(snippet, RigSystem::kUrdf);
    // The specification: child in parent is origin, then a turn by the position about the axis.
    const Eigen::Vector3d origin_rpy = vector_in(text, "<origin xyz=\"0 0 0\" rpy=\"([^\"]*)\""),
                          axis = vector_in(text, "<axis xyz=\"([^\"]*)\""),
                          xyz = vector_in(text, "type=\"fixed\">[\\s\\S]*<origin xyz=\"([^\"]*)\""),
                          rpy = vector_in(text, "type=\"fixed\">[\\s\\S]*rpy=\"([^\"]*)\"");
    const Eigen::Vector3d p_in_laser = random.vector();
    const double position = 2 * random.next();
    const Eigen::Vector3d p_in_base =
        rotation_of(origin_rpy) *
        (Eigen::AngleAxisd(position, axis.normalized()) * (rotation_of(rpy) * p_in_laser + xyz));
    EXPECT_LT((p_in_base - placed(snippet.rig, p_in_laser, position)).norm(), kDigits) << text;
  }
}

TEST(RigSnippet, StaticTransformsAreTheMount) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const RigSnippet snippet = random_snippet(random);
    const Rig::Mount& mount = snippet.rig.mount;
    const Eigen::Matrix3d r = rotation_from_rpy(mount.laser_in_motor_rpy_deg).toRotationMatrix();
    const std::string ros2 = rig_snippet(snippet, RigSystem::kRos2StaticTf);
    const auto value = [&](const std::string& name) {
      return numbers_in(ros2, "--" + name + " ([-0-9.]+)").at(0);
    };
    EXPECT_LT((rotation_of({value("roll"), value("pitch"), value("yaw")}) - r).norm(), kDigits);
    EXPECT_LT((Eigen::Vector3d(value("x"), value("y"), value("z")) - mount.laser_in_motor_xyz_m).norm(),
              kDigits);
    const std::string ros1 = rig_snippet(snippet, RigSystem::kLaserAssembler);
    const auto args = numbers_in(ros1, "args=\"([-0-9. ]*) motor_link laser\"");
    ASSERT_EQ(args.size(), 6U) << ros1;
    EXPECT_LT((rotation_of({args[5], args[4], args[3]}) - r).norm(), kDigits) << "x y z yaw pitch roll";
  }
}

TEST(RigSnippet, FastLioGetsTheCloudsFrameInTheImusAndTheOffsetWithItsSign) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    RigSnippet snippet = random_snippet(random);
    snippet.rig.imu.topic = "/imu";
    snippet.rig.imu.pose_in_base_xyz_m = random.vector();
    snippet.rig.imu.pose_in_base_rpy_deg = 180 * random.vector();
    const std::string text = rig_snippet(snippet, RigSystem::kFastLio);
    const Eigen::Vector3d t = vector_in(text, "extrinsic_T: \\[([^\\]]*)\\]");
    const auto r = numbers_in(text, "extrinsic_R: \\[([^\\]]*)\\]");
    ASSERT_EQ(r.size(), 9U) << text;
    // FAST_LIO: p_imu = R p_cloud + T; the rig file: p_base = R(rpy) p_imu + xyz.
    const Eigen::Vector3d p_in_base = random.vector();
    const Eigen::Vector3d p_in_imu =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data()) * p_in_base + t;
    const Eigen::Vector3d back = rotation_from_rpy(snippet.rig.imu.pose_in_base_rpy_deg) * p_in_imu +
                                 snippet.rig.imu.pose_in_base_xyz_m;
    EXPECT_LT((back - p_in_base).norm(), kDigits);
    // It subtracts the value from the IMU's stamps; with an IMU on the motor's clock that gives the laser's.
    const double t_laser_s = 10, t_motor_s = t_laser_s + snippet.offset.offset_s;
    EXPECT_NEAR(t_motor_s - numbers_in(text, "time_offset_lidar_to_imu: ([-0-9.]+)\n").at(0), t_laser_s,
                1e-8);
  }
}

TEST(RigSnippet, SaysHowStampsAreMovedWhereThereIsNoPlaceForTheOffset) {
  Random random;
  RigSnippet snippet = random_snippet(random);
  snippet.offset.offset_s = 0.024;
  for (const RigSystem system : {RigSystem::kUrdf, RigSystem::kXacro, RigSystem::kRos2StaticTf,
                                 RigSystem::kLaserAssembler, RigSystem::kCartographer}) {
    const std::string text = rig_snippet(snippet, system);
    EXPECT_NE(text.find("subtract 0.024000000 s from each stamp of the joint"), std::string::npos) << text;
    EXPECT_NE(text.find("sweepscope apply REC -o OUT"), std::string::npos) << text;
  }
  snippet.offset.offset_s = -0.024;
  EXPECT_NE(rig_snippet(snippet, RigSystem::kUrdf).find("add 0.024000000 s to each stamp of the joint"),
            std::string::npos);
  snippet.offset.rate = 1e-6;
  snippet.rig.gear.play_deg = 0.1;
  snippet.rig.motor.scale = -0.5;
  const std::string text = rig_snippet(snippet, RigSystem::kUrdf);
  EXPECT_NE(text.find("The offset changes over time"), std::string::npos) << text;
  EXPECT_NE(text.find("Gear play"), std::string::npos) << text;
  EXPECT_NE(text.find("multiply those of the recording by 0.500000000"), std::string::npos) << text;
}

TEST(RigSnippet, EachNamesItsSource) {
  Random random;
  const RigSnippet snippet = random_snippet(random);
  const auto has = [&](RigSystem system, const char* words) {
    EXPECT_NE(rig_snippet(snippet, system).find(words), std::string::npos) << words;
  };
  has(RigSystem::kUrdf, "http://wiki.ros.org/urdf/XML/joint");
  has(RigSystem::kXacro, "http://wiki.ros.org/xacro");
  has(RigSystem::kRos2StaticTf, "ros2 run tf2_ros static_transform_publisher");
  has(RigSystem::kLaserAssembler, "http://wiki.ros.org/laser_assembler");
  has(RigSystem::kCartographer, "google-cartographer-ros.readthedocs.io");
  has(RigSystem::kFastLio, "https://github.com/hku-mars/FAST_LIO");
}

TEST(RigSnippet, HostileNamesStayInsideTheirQuotes) {
  Random random;
  RigSnippet snippet = random_snippet(random);
  snippet.rig.motor.joint = "a\"/><evil b=\"";
  snippet.rig.laser.topic = "/scan\n--\"]]-->";
  snippet.laser_frame = "x; rm -rf '$HOME'";
  snippet.source = "a--b\n.bag";
  for (const RigSystem system : {RigSystem::kUrdf, RigSystem::kXacro, RigSystem::kLaserAssembler}) {
    const std::string text = rig_snippet(snippet, system);
    EXPECT_EQ(text.find("<evil"), std::string::npos) << text;
    const std::size_t begin = text.find("<!--") + 4;
    EXPECT_EQ(text.substr(begin, text.find("-->") - begin).find("--"), std::string::npos) << text;
  }
  EXPECT_NE(
      rig_snippet(snippet, RigSystem::kRos2StaticTf).find("--child-frame-id 'x; rm -rf '\\''$HOME'\\'''\n"),
      std::string::npos)
      << rig_snippet(snippet, RigSystem::kRos2StaticTf);
  EXPECT_EQ(rig_snippet(snippet, RigSystem::kCartographer).find("\n--\"]]"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
