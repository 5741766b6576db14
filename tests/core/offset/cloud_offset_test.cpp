#include <gtest/gtest.h>

#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/recording/read_recording.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/recording/cloud_bytes.hpp"
#include "tests/core/recording/test_bag.hpp"
#include "tests/core/recording/test_database.hpp"

namespace sweepscope {
namespace {

using test::kDegree, test::MessageBytes;

/// A scanner of 16 rings, 2 deg apart, that turns ten times a second about its z axis, tilted about y over
/// +-45 deg by a slow motor, in a hall.
struct CloudBench {
  static constexpr int kRings = 16, kBeams = 600;
  static constexpr double kTurn_s = 0.1, kStart_s = 1'700'000'000, kNoise_m = 0.01;
  double offset_s = 0.0243;
  double sweep_s = 2.057;
  double duration_s = 18.5;
  bool walks = false;
  Eigen::Vector3d laser_in_motor_m{0.05, 0, 0.08};

  double angle_rad(double t_s) const {
    const double phase = std::fmod(t_s + 10 * sweep_s, 2 * sweep_s) / sweep_s;
    return 45 * kDegree * (phase < 1 ? 2 * phase - 1 : 3 - 2 * phase);
  }
  Eigen::Isometry3d world_from_base(double t_s) const {
    if (!walks) return Eigen::Isometry3d::Identity();
    return Eigen::Translation3d(1.5 * std::sin(0.21 * t_s), 1.1 * std::sin(0.17 * t_s + 1) - 0.9,
                                0.1 * std::sin(0.4 * t_s)) *
           Eigen::AngleAxisd(0.35 * std::sin(0.15 * t_s), Eigen::Vector3d::UnitZ());
  }

  void record(const std::filesystem::path& path) const {
    test::TestDatabase database(path);
    database.topic(1, "/points", "sensor_msgs/msg/PointCloud2");
    database.topic(2, "/joint_states", "sensor_msgs/msg/JointState");
    const simulation::Mesh mesh = test::hall();
    const simulation::RayCaster caster(mesh);
    for (int turn = 0; turn * kTurn_s < duration_s; ++turn) {
      const auto [seconds, nanoseconds] = stamp(turn * kTurn_s);
      database.message(1, receive_ns(turn * kTurn_s + 0.11),
                       cloud(caster, turn).message(MessageBytes::kCdr, seconds, nanoseconds));
    }
    for (int i = -30; i * 0.01 < duration_s + 0.3; ++i) {
      const auto [seconds, nanoseconds] = stamp(i * 0.01 + offset_s);
      database.message(
          2, receive_ns(i * 0.01 + 0.002),
          test::joint_bytes(MessageBytes::kCdr, seconds, nanoseconds, {"tilt"},
                            {std::round(angle_rad(i * 0.01) / (0.02 * kDegree)) * 0.02 * kDegree}));
    }
  }

 private:
  static std::int64_t receive_ns(double t_s) { return std::llround((kStart_s + t_s) * 1e9); }
  static std::pair<std::uint32_t, std::uint32_t> stamp(double t_s) {
    const std::int64_t ns = static_cast<std::int64_t>(kStart_s) * 1'000'000'000 + std::llround(t_s * 1e9);
    return {static_cast<std::uint32_t>(ns / 1'000'000'000), static_cast<std::uint32_t>(ns % 1'000'000'000)};
  }
  test::CloudBytes cloud(const simulation::RayCaster& caster, int turn) const {
    test::CloudBytes bytes("time", test::CloudType::kFloat32, true);
    simulation::Random random(1, 7, std::uint64_t(turn));
    for (int beam = 0; beam < kBeams; ++beam) {
      const double since_s = beam * kTurn_s / kBeams, t_s = turn * kTurn_s + since_s;
      const Eigen::Isometry3d world_from_laser = world_from_base(t_s) *
                                                 Eigen::AngleAxisd(angle_rad(t_s), Eigen::Vector3d::UnitY()) *
                                                 Eigen::Translation3d(laser_in_motor_m);
      const double azimuth = -test::kPi + beam * 2 * test::kPi / kBeams;
      for (std::uint16_t ring = 0; ring < kRings; ++ring) {
        const double elevation = (2.0 * ring - 15) * kDegree;
        const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        const auto hit = caster.cast(world_from_laser.translation(),
                                     (world_from_laser.linear() * direction).normalized(), 30);
        const double noise_m = kNoise_m * random.normal();
        // Some return nothing, and drivers leave them out.
        if (!hit || random.uniform() < 0.02) continue;
        const Eigen::Vector3f p = ((hit->range_m + noise_m) * direction).cast<float>();
        bytes.point(p.x(), p.y(), p.z(), since_s, ring);
      }
    }
    return bytes;
  }
};

class CloudOffset : public testing::Test {
 protected:
  Recording read(const CloudBench& bench) const {
    bench.record(folder_ / "clouds.db3");
    ReadOptions options;
    options.rig.emplace();
    options.rig->mount.axis = Eigen::Vector3d::UnitY();
    options.rig->mount.laser_in_motor_xyz_m = bench.laser_in_motor_m;
    auto recording = read_recording(folder_ / "clouds.db3", options, Job());
    EXPECT_TRUE(recording) << recording.error().message;
    return recording ? std::move(*recording) : Recording();
  }
  test::ScratchFolder folder_;
};

std::string reasons(const Estimate& estimate) {
  std::string text;
  for (const std::string& reason : estimate.reasons) text += reason + "\n";
  return text;
}

TEST_F(CloudOffset, DirectFindsItForARigThatStoodStill) {
  const Recording recording = read({});
  EXPECT_EQ(recording.scans.size(), 185U * CloudBench::kRings);
  EXPECT_TRUE(recording.report.warnings.empty()) << recording.report.warnings.front();
  EXPECT_NEAR(recording.report.laser_stamps.median_period_s, 0.1, 1e-6);
  EstimateOptions options;
  options.method = Method::kDirect;
  const auto found = estimate(recording, options, Job());
  ASSERT_TRUE(found);
  ASSERT_TRUE(found->offset_s) << reasons(*found);
  EXPECT_EQ(found->kind, "stationary");
  EXPECT_NEAR(*found->offset_s * 1e3, 24.3, 1.0);
}

TEST_F(CloudOffset, MovingAndDirectFindItForAWalk) {
  CloudBench bench;
  bench.walks = true;
  bench.duration_s = 46;
  const Recording recording = read(bench);
  for (const Method method : {Method::kMoving, Method::kDirect}) {
    EstimateOptions options;
    options.method = method;
    const auto found = estimate(recording, options, Job());
    ASSERT_TRUE(found);
    ASSERT_TRUE(found->offset_s) << reasons(*found);
    EXPECT_EQ(found->kind, "moving");
    EXPECT_NEAR(*found->offset_s * 1e3, 24.3, 2.0);
  }
}

}  // namespace
}  // namespace sweepscope
