#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <numbers>

#include "core/offset/estimator.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using Eigen::Vector3d;
using simulation::MotorAxis;
using Times = simulation::BeamTimes;

const Vector3d kLow(-4, -3, 0), kHigh(6, 3, 2.8), kRig(0.3, -0.2, 1.2);

/// When beam i of n is fired, after the stamp.
using Law = std::function<double(double i, double n, double increment_s)>;
double spread(double i, double, double increment_s) {
  return i * increment_s;
}
double instant(double, double, double) {
  return 0;
}
double reversed(double i, double n, double increment_s) {
  return (n - 1 - i) * increment_s;
}

/// How far the walls of the box are from the rig.
double distance_m(const Vector3d& direction) {
  double least_m = 1e9;
  for (int i = 0; i < 3; ++i)
    if (direction[i] != 0)
      least_m = std::min(least_m, ((direction[i] > 0 ? kHigh : kLow)[i] - kRig[i]) / direction[i]);
  return least_m;
}

/// A stationary rig in a box whose motor is sampled finely.
class DriverMessages : public test::FolderTest {
 protected:
  DriverMessages() {
    std::ofstream(folder_ / "box.obj")
        << "v -4 -3 0\nv 6 -3 0\nv 6 3 0\nv -4 3 0\nv -4 -3 2.8\nv 6 -3 2.8\nv 6 3 2.8\nv -4 3 2.8\n"
           "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    exact_.own.mesh = folder_ / "box.obj";
    exact_.own.placement.at_m = kRig;
    exact_.duration_s = 0.8;
    exact_.noise_m = 0;
    exact_.dropout = 0;
    exact_.encoder_hz = 2000;
    exact_.encoder_jitter_s = 0;
    exact_.encoder_step_deg = 1e-4;
  }

  static Simulation made(const SimulationOptions& options) { return simulate(options, Job()).value(); }

  /// How far the ranges of the messages are at most from the walls, if beams are fired by this law.
  static double error_m(const SimulationOptions& options, const Law& law) {
    const Simulation simulation = made(options);
    const RawRecording raw = messages_of(simulation);
    const RawLaser& laser = raw.lasers[0];
    const RawJoint& joint = raw.joints[0];
    MotorTrack motor;
    for (std::size_t i = 0; i < joint.stamps.size(); ++i) {
      motor.time_s.push_back(seconds(simulation, joint.stamps[i]));
      motor.angle_rad.push_back(joint.positions[i]);
    }
    const Vector3d axis = rig_of(options).mount.axis;
    const double roll_rad = rig_of(options).mount.laser_in_motor_rpy_deg.x() * std::numbers::pi / 180;
    double most_m = 0;
    std::size_t compared = 0;
    for (const RawScan& scan : laser.scans) {
      for (std::uint32_t i = 0; i < scan.beams; ++i) {
        const float range_m = laser.ranges_m[scan.first_range + i];
        if (!std::isfinite(range_m)) continue;
        const double t_s = seconds(simulation, scan.stamps) + law(i, scan.beams, scan.time_increment_s);
        const double angle_rad = double{scan.angle_min_rad} + i * double{scan.angle_increment_rad};
        const Vector3d in_laser(std::cos(angle_rad), std::sin(angle_rad), 0);
        const Vector3d direction = Eigen::AngleAxisd(motor.angle_at(t_s + options.offset_s), axis) *
                                   (Eigen::AngleAxisd(roll_rad, Vector3d::UnitX()) * in_laser);
        most_m = std::max(most_m, std::abs(range_m - distance_m(direction)));
        ++compared;
      }
    }
    EXPECT_GT(compared, 1500U);
    return most_m;
  }

  static double seconds(const Simulation& simulation, const MessageStamps& stamps) {
    return static_cast<double>(stamps.header_ns - simulation.recording.epoch_ns) * 1e-9;
  }

  SimulationOptions exact_;
};

constexpr double kExact_m = 0.002, kWrong_m = 0.02;

TEST_F(DriverMessages, SpreadBeamsAreFiredInTheOrderOfTheArray) {
  EXPECT_LT(error_m(exact_, spread), kExact_m);
  EXPECT_GT(error_m(exact_, reversed), kWrong_m);
  EXPECT_GT(error_m(exact_, instant), kWrong_m);
}

TEST_F(DriverMessages, TheBeamsOfAnInstantScanAreAllFiredAtItsStamp) {
  exact_.beam_times = Times::kInstant;
  EXPECT_LT(error_m(exact_, spread), kExact_m) << "by a time_increment of 0";
  EXPECT_EQ(messages_of(made(exact_)).lasers[0].scans[3].time_increment_s, 0);
  EXPECT_EQ(rig_of(exact_).laser.time_increment_s, 0);
}

TEST_F(DriverMessages, TheLastBeamOfAReversedArrayIsFiredFirst) {
  exact_.beam_times = Times::kReversed;
  EXPECT_LT(error_m(exact_, reversed), kExact_m);
  EXPECT_GT(error_m(exact_, spread), kWrong_m);
  const RawScan scan = messages_of(made(exact_)).lasers[0].scans[3];
  EXPECT_GT(scan.time_increment_s, 0);
  EXPECT_GT(scan.angle_increment_rad, 0);
  EXPECT_EQ(rig_of(exact_).laser.time_increment_s, -double{scan.time_increment_s});
}

TEST_F(DriverMessages, APartOfATurnHasItsOwnFirstAngleAndStamp) {
  exact_.scanner = *simulation::scanner("ld19");
  exact_.beam_times = Times::kSpread;
  exact_.parts = 12;
  EXPECT_LT(error_m(exact_, spread), kExact_m);
  const RawLaser laser = messages_of(made(exact_)).lasers[0];
  ASSERT_EQ(laser.scans.size(), 8U * 12U);
  std::uint32_t beams = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const RawScan& scan = laser.scans[12 + i];
    EXPECT_NEAR(scan.angle_min_rad, beams * 0.8 * std::numbers::pi / 180, 1e-5);
    EXPECT_NEAR(double(scan.stamps.header_ns - laser.scans[12].stamps.header_ns), beams * 0.1e9 / 450, 10);
    EXPECT_FLOAT_EQ(scan.time_increment_s, 0.1F / 450);
    EXPECT_FLOAT_EQ(scan.scan_time_s, 0.1F);
    beams += scan.beams;
  }
  EXPECT_EQ(beams, 450U);
}

TEST_F(DriverMessages, PartsOfATurnGoWithEveryOrderOfBeams) {
  exact_.scanner = *simulation::scanner("ld19");
  exact_.parts = 7;
  EXPECT_LT(error_m(exact_, reversed), kExact_m);
  EXPECT_GT(error_m(exact_, spread), kWrong_m);
  exact_.beam_times = Times::kInstant;
  EXPECT_LT(error_m(exact_, instant), kExact_m);
}

TEST_F(DriverMessages, PartsHoldTheBeamsOfWholeTurns) {
  exact_.noise_m = 0.01;
  const Recording whole = made(exact_).recording;
  exact_.parts = 12;
  const Recording parts = made(exact_).recording;
  ASSERT_EQ(parts.ranges_m.size(), whole.ranges_m.size());
  for (std::size_t i = 0; i < whole.ranges_m.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(parts.ranges_m[i]),
              std::bit_cast<std::uint32_t>(whole.ranges_m[i]));
}

TEST_F(DriverMessages, AScanIsStampedAtItsLastBeamIfAskedFor) {
  exact_.stamp_at = StampAt::kLastBeam;
  const auto law = [](double i, double n, double increment_s) { return (i - n + 1) * increment_s; };
  EXPECT_LT(error_m(exact_, law), kExact_m);
  EXPECT_EQ(rig_of(exact_).laser.stamp_at, StampAt::kLastBeam);
}

TEST_F(DriverMessages, TheMotorTurnsAboutTheAxisThatTheRigNames) {
  for (const MotorAxis axis : {MotorAxis::kX, MotorAxis::kY, MotorAxis::kZ, MotorAxis::kMinusX,
                               MotorAxis::kMinusY, MotorAxis::kMinusZ})
    for (const bool upside_down : {false, true}) {
      exact_.axis = axis;
      exact_.laser_upside_down = upside_down;
      EXPECT_LT(error_m(exact_, spread), kExact_m) << name_of(axis) << upside_down;
    }
}

TEST_F(DriverMessages, AnUpsideDownLaserSeesTheMirrorImage) {
  const auto upright = made(exact_).recording.ranges_m;
  exact_.laser_upside_down = true;
  EXPECT_NE(made(exact_).recording.ranges_m, upright);
  EXPECT_EQ(rig_of(exact_).mount.laser_in_motor_rpy_deg, Vector3d(180, 0, 0));
}

TEST_F(DriverMessages, EveryScannerIsWrittenAsItsDriverDoes) {
  struct Expected {
    const char* name;
    std::uint32_t beams;
    double first_deg, last_deg, rate_hz, min_m, max_m;
    Times times;
  };
  for (const Expected& e : {Expected{"utm30lx-180", 721, -90, 90, 40, 0.1, 30, Times::kSpread},
                            Expected{"utm30lx", 1081, -135, 135, 40, 0.1, 30, Times::kSpread},
                            Expected{"ust10lx", 1081, -135, 135, 40, 0.06, 10, Times::kSpread},
                            Expected{"urg04lx", 682, -119.53, 119.88, 10, 0.02, 5.6, Times::kSpread},
                            Expected{"tim571", 811, -135, 135, 15, 0.05, 25, Times::kSpread},
                            Expected{"lms111", 541, -135, 135, 50, 0.5, 20, Times::kSpread},
                            Expected{"rplidar-a1", 800, -180, 179.55, 10, 0.15, 12, Times::kReversed},
                            Expected{"rplidar-s2", 3200, -180, 179.8875, 10, 0.15, 30, Times::kReversed},
                            Expected{"ld19", 450, 0, 359.2, 10, 0.02, 12, Times::kReversed}}) {
    exact_.scanner = *simulation::scanner(e.name);
    EXPECT_LT(error_m(exact_, e.times == Times::kReversed ? reversed : spread), kExact_m) << e.name;
    const RawLaser laser = messages_of(made(exact_)).lasers[0];
    const RawScan& scan = laser.scans[5];
    EXPECT_EQ(scan.beams, e.beams) << e.name;
    EXPECT_NEAR(scan.angle_min_rad * 180 / std::numbers::pi, e.first_deg, 0.01) << e.name;
    EXPECT_NEAR(scan.angle_max_rad * 180 / std::numbers::pi, e.last_deg, 0.01) << e.name;
    EXPECT_NEAR(double(scan.stamps.header_ns - laser.scans[0].stamps.header_ns), 5e9 / e.rate_hz, 2)
        << e.name;
    EXPECT_NEAR(scan.scan_time_s * e.rate_hz, 1, 1e-6) << e.name;
    // A mirror that turns steadily.
    EXPECT_NEAR(scan.time_increment_s, scan.scan_time_s * scan.angle_increment_rad / (2 * std::numbers::pi),
                2e-4 * scan.time_increment_s)
        << e.name;
    EXPECT_FLOAT_EQ(scan.range_min_m, float(e.min_m)) << e.name;
    EXPECT_FLOAT_EQ(scan.range_max_m, float(e.max_m)) << e.name;
  }
  EXPECT_EQ(simulation::scanner_names().size(), 10U) << "and a 3D scanner";
  EXPECT_FALSE(simulation::scanner("lms200"));
}

/// A number of a point.
template <typename Number>
Number number_at(const RawCloud& cloud, std::size_t point, std::size_t field) {
  Number number;
  std::memcpy(&number, cloud.data.data() + point * cloud.point_bytes + cloud.fields[field].offset,
              sizeof number);
  return number;
}

TEST_F(DriverMessages, PointsOfA3dScannerLieOnTheWallsAtTheirOwnTimes) {
  exact_.scanner = *simulation::scanner("vlp16");
  const Simulation simulation = made(exact_);
  const RawRecording raw = messages_of(simulation);
  const RawLaser& laser = raw.lasers[0];
  ASSERT_EQ(laser.clouds.size(), 8U);
  ASSERT_EQ(simulation.recording.scans.size(), 8U * 16U);
  MotorTrack motor;
  for (std::size_t i = 0; i < raw.joints[0].stamps.size(); ++i) {
    motor.time_s.push_back(seconds(simulation, raw.joints[0].stamps[i]));
    motor.angle_rad.push_back(raw.joints[0].positions[i]);
  }
  double most_m = 0, most_deg = 0, last_s = 0;
  for (const RawCloud& cloud : laser.clouds) {
    EXPECT_EQ(cloud.width, 16U * 1808U) << "every ray meets a wall";
    for (std::size_t i = 0; i < cloud.width; i += 7) {
      const Vector3d p_m(number_at<float>(cloud, i, 0), number_at<float>(cloud, i, 1),
                         number_at<float>(cloud, i, 2));
      const double after_s = number_at<float>(cloud, i, 5);
      const double angle_rad = motor.angle_at(seconds(simulation, cloud.stamps) + after_s + exact_.offset_s);
      const Vector3d direction = Eigen::AngleAxisd(angle_rad, Vector3d::UnitX()) * p_m.normalized();
      most_m = std::max(most_m, std::abs(p_m.norm() - distance_m(direction)));
      const double ring_deg = -15 + 2.0 * number_at<std::uint16_t>(cloud, i, 4);
      most_deg =
          std::max(most_deg, std::abs(std::asin(p_m.normalized().z()) * 180 / std::numbers::pi - ring_deg));
      last_s = std::max(last_s, after_s);
    }
  }
  EXPECT_LT(most_m, kExact_m);
  EXPECT_LT(most_deg, 1e-3);
  EXPECT_NEAR(last_s, 0.1, 2e-4);
}

TEST_F(DriverMessages, TheNoiseIsTheScannersUnlessOneIsGiven) {
  exact_.scanner = *simulation::scanner("tim571");
  const auto deviation_m = [&] {
    SimulationOptions without = exact_;
    without.noise_m = 0;
    const auto noisy_m = made(exact_).recording.ranges_m, exact_m = made(without).recording.ranges_m;
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < noisy_m.size(); ++i)
      if (std::isfinite(noisy_m[i])) squares += std::pow(noisy_m[i] - exact_m[i], 2), ++count;
    return std::sqrt(squares / count);
  };
  exact_.noise_m.reset();
  EXPECT_NEAR(deviation_m(), 0.020, 0.001);
  exact_.noise_m = 0.005;
  EXPECT_NEAR(deviation_m(), 0.005, 0.0003);
}

TEST_F(DriverMessages, RepeatedMotorAnglesHaveNewStampsUntilTheNextAngle) {
  exact_.encoder_hz = 20;
  const RawJoint once = messages_of(made(exact_)).joints[0];
  exact_.motor_repeats = 5;
  const RawJoint joint = messages_of(made(exact_)).joints[0];
  ASSERT_EQ(joint.positions.size(), 5 * once.positions.size());
  for (std::size_t i = 0; i + 1 < once.positions.size(); ++i) {
    EXPECT_EQ(joint.stamps[5 * i].header_ns, once.stamps[i].header_ns);
    for (std::size_t repeat = 0; repeat < 5; ++repeat) {
      EXPECT_EQ(joint.positions[5 * i + repeat], once.positions[i]);
      EXPECT_NEAR(double(joint.stamps[5 * i + repeat].header_ns - once.stamps[i].header_ns),
                  1e7 * double(repeat), 5);
    }
  }
}

TEST_F(DriverMessages, FieldsAreWrittenWrongIfAskedFor) {
  exact_.no_time_increment = true;
  exact_.scan_time_factor = 1.5;
  exact_.motor_in_degrees = true;
  const Simulation simulation = made(exact_);
  const RawRecording raw = messages_of(simulation);
  EXPECT_EQ(raw.lasers[0].scans[2].time_increment_s, 0);
  EXPECT_FLOAT_EQ(raw.lasers[0].scans[2].scan_time_s, 1.5F * 0.025F);
  EXPECT_NEAR(raw.joints[0].positions[30], simulation.recording.motor.angle_rad[30] * 180 / std::numbers::pi,
              1e-9);
  EXPECT_EQ(error_m(exact_, spread) > kWrong_m, true) << "the motor's angles are no radians";
}

TEST_F(DriverMessages, TheMotorSwingsAsFarAsAskedFor) {
  exact_.swing_deg = 30;
  EXPECT_LT(error_m(exact_, spread), kExact_m);
  const auto angles_rad = made(exact_).recording.motor.angle_rad;
  const auto [least, most] = std::ranges::minmax(angles_rad);
  EXPECT_NEAR(least * 180 / std::numbers::pi, -30, 0.1);
  EXPECT_NEAR(most * 180 / std::numbers::pi, 30, 0.1);
}

// Read with the rig that the simulation names, messages become the recording that is in memory.
TEST_F(DriverMessages, TheRigReadsThemAsTheyWereMade) {
  exact_.axis = MotorAxis::kMinusY;
  exact_.laser_upside_down = true;
  exact_.stamp_at = StampAt::kLastBeam;
  exact_.no_time_increment = true;
  exact_.motor_in_degrees = true;
  const Simulation simulation = made(exact_);
  const Recording read = assemble(messages_of(simulation), rig_of(exact_), StampSource::kHeader).value();
  const Recording& made = simulation.recording;
  ASSERT_EQ(read.scans.size(), made.scans.size());
  for (std::size_t i = 0; i < made.scans.size(); ++i) {
    EXPECT_NEAR(read.scans[i].first_beam_s, made.scans[i].first_beam_s, 2e-9);
    EXPECT_NEAR(read.scans[i].time_increment_s, made.scans[i].time_increment_s, 1e-12);
    EXPECT_EQ(read.scans[i].angle_min_rad, made.scans[i].angle_min_rad);
  }
  ASSERT_EQ(read.motor.angle_rad.size(), made.motor.angle_rad.size());
  for (std::size_t i = 0; i < made.motor.angle_rad.size(); ++i)
    EXPECT_NEAR(read.motor.angle_rad[i], made.motor.angle_rad[i], 1e-12);
  EXPECT_EQ(read.rig.mount.axis, -Vector3d::UnitY());
}

// The recording in memory is the true reading, in the order of time.
TEST_F(DriverMessages, TheRecordingInMemoryGivesTheOffset) {
  SimulationOptions options;
  options.scene = "room-2";
  options.sweep_s = 0.513;
  for (const char* name : {"rplidar-a1", "ld19"}) {
    options.scanner = *simulation::scanner(name);
    const Estimate found = estimate(made(options).recording, {}, Job()).value();
    ASSERT_TRUE(found.offset_s) << name << testing::PrintToString(found.reasons());
    EXPECT_NEAR(*found.offset_s, 0.024, 5 * found.sigma_s.value_or(0)) << name;
  }
}

TEST_F(DriverMessages, ARigFileIsWrittenWhereReadingNeedsOne) {
  const auto files = [&] { return files_of_simulation(exact_, "a.bag").size(); };
  EXPECT_EQ(files(), 3U);
  exact_.parts = 4;
  exact_.motor_repeats = 3;
  EXPECT_EQ(files(), 3U) << "nothing that a rig file could say";
  exact_.beam_times = Times::kReversed;
  EXPECT_EQ(files(), 4U);
  ASSERT_TRUE(write_truth(made(exact_), folder_ / "a.bag"));
  EXPECT_NE(test::contents_of(folder_ / "a.rig.yaml").find("time_increment_s: -1.736"), std::string::npos);
  exact_ = {};
  exact_.axis = MotorAxis::kY;
  exact_.duration_s = 0.2;
  ASSERT_TRUE(write_truth(made(exact_), folder_ / "b.bag"));
  EXPECT_EQ(read_rig(folder_ / "b.rig.yaml").value().mount.axis, Vector3d::UnitY());
}

TEST_F(DriverMessages, WrongOptionsAreRefused) {
  const auto refused = [&](auto change) {
    SimulationOptions options = exact_;
    change(options);
    const auto result = simulate(options, Job());
    return result ? "" : result.error().message;
  };
  EXPECT_NE(refused([](auto& o) { o.parts = 0; }).find("parts of a turn is 0"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.motor_repeats = 101; }).find("between 1 and 100"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.swing_deg = 0; }).find("swing is 0 deg"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.scan_time_factor = -1; }).find("scan_time"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.stamp_at = StampAt::kArrival; }).find("first or last beam"),
            std::string::npos);
}

}  // namespace
}  // namespace sweepscope
