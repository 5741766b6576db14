#include "tests/core/cloud_bench.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "tests/core/recording/cloud_bytes.hpp"

namespace sweepscope::test {
namespace {

std::int64_t receive_ns(double t_s) {
  return std::llround((CloudBench::kStart_s + t_s) * 1e9);
}
std::pair<std::uint32_t, std::uint32_t> stamp(double t_s) {
  const std::int64_t ns =
      static_cast<std::int64_t>(CloudBench::kStart_s) * 1'000'000'000 + std::llround(t_s * 1e9);
  return {static_cast<std::uint32_t>(ns / 1'000'000'000), static_cast<std::uint32_t>(ns % 1'000'000'000)};
}

}  // namespace

double CloudBench::angle_rad(double t_s) const {
  const double phase = std::fmod(t_s + 10 * sweep_s, 2 * sweep_s) / sweep_s;
  return swing_deg * kDegree * (phase < 1 ? 2 * phase - 1 : 3 - 2 * phase);
}

void CloudBench::play(MessageBytes::Form form, const Take& take) const {
  const simulation::RayCaster caster(mesh);
  int sample = -30;
  for (int turn = 0; turn * turn_s < duration_s; ++turn) {
    const double received_s = turn * turn_s + 1.1 * turn_s;
    for (; sample * 0.01 + 0.002 < received_s; ++sample) play_motor(sample, form, take);
    const auto [seconds, nanoseconds] = stamp(turn * turn_s);
    take("/points", cloud_type(), receive_ns(received_s), cloud(caster, turn, form, seconds, nanoseconds));
  }
  for (; sample * 0.01 < duration_s + 0.3; ++sample) play_motor(sample, form, take);
}

Rig CloudBench::rig() const {
  Rig rig;
  rig.mount.axis = axis;
  rig.mount.laser_in_motor_xyz_m = laser_in_motor_m;
  return rig;
}

RawRecording CloudBench::raw(CloudDetail detail) const {
  RawRecording raw;
  raw.file = raw.name = "clouds";
  const Rig of_bench = rig();
  MessageCollector collector(of_bench, raw, detail);
  play(MessageBytes::kCdr, [&](const char* topic, const char* type, std::int64_t receive,
                               const std::string& bytes) {
    const std::size_t number = collector.number_of({topic, type, Encoding::kCdr});
    EXPECT_FALSE(collector.add(number, receive, as_span(bytes), [] { return std::string("a message"); }));
  });
  collector.finish();
  return raw;
}

Recording CloudBench::record() const {
  auto recording = assemble(raw(), rig(), {});
  EXPECT_TRUE(recording) << recording.error().message;
  return recording ? std::move(*recording) : Recording();
}

void CloudBench::play_motor(int sample, MessageBytes::Form form, const Take& take) const {
  const double t_s = sample * 0.01, step_rad = encoder_step_deg * kDegree;
  const auto [seconds, nanoseconds] = stamp(t_s + offset_s);
  take("/joint_states", "sensor_msgs/JointState", receive_ns(t_s + 0.002),
       joint_bytes(form, seconds, nanoseconds, {"tilt"}, {std::round(angle_rad(t_s) / step_rad) * step_rad}));
}

const char* CloudBench::cloud_type() const {
  if (driver == Driver::kLivox) return "livox_ros_driver/CustomMsg";
  return driver == Driver::kLivox2 ? "livox_ros_driver2/CustomMsg" : "sensor_msgs/PointCloud2";
}

/// The cloud of a turn, as the driver's message.
std::string CloudBench::cloud(const simulation::RayCaster& caster, int turn, MessageBytes::Form form,
                              std::uint32_t seconds, std::uint32_t nanoseconds) const {
  LivoxBytes livox;
  CloudBytes in_s("time", CloudType::kFloat32, ring_field);
  CloudBytes in_ns("offset_time", CloudType::kUint32, ring_field);
  cast_turn(caster, turn, [&](const Eigen::Vector3f& p, double since_s, int ring) {
    const auto ns = static_cast<std::uint32_t>(std::llround(since_s * 1e9));
    in_s.point(p.x(), p.y(), p.z(), since_s, static_cast<std::uint16_t>(ring));
    in_ns.point(p.x(), p.y(), p.z(), ns, static_cast<std::uint16_t>(ring));
    livox.point({p.x(), p.y(), p.z(), ns, static_cast<std::uint8_t>(ring)});
  });
  if (driver == Driver::kSeconds) return in_s.message(form, seconds, nanoseconds);
  if (driver == Driver::kNanoseconds) return in_ns.message(form, seconds, nanoseconds);
  return livox.message(form, seconds, nanoseconds, seconds * std::uint64_t{1'000'000'000} + nanoseconds);
}

void CloudBench::cast_turn(const simulation::RayCaster& caster, int turn, const Add& add) const {
  simulation::Random random(seed, 7, std::uint64_t(turn));
  for (int beam = 0; beam < beams; ++beam) {
    const double since_s = beam * turn_s / beams, t_s = turn * turn_s + since_s;
    const Eigen::Isometry3d world_from_laser = world_from_base(t_s) *
                                               Eigen::AngleAxisd(angle_rad(t_s), axis.normalized()) *
                                               Eigen::Translation3d(laser_in_motor_m);
    constexpr double kPrism_rad = 0.3, kFirst_radps = 115, kSecond_radps = -73.3;
    const double in_ring = (clockwise ? -1 : 1) * (-kPi + beam * 2 * kPi / beams);
    const double azimuth =
        rosette ? kPrism_rad * (std::cos(kFirst_radps * t_s) + std::cos(kSecond_radps * t_s)) : in_ring;
    const double up =
        rosette ? kPrism_rad * (std::sin(kFirst_radps * t_s) + std::sin(kSecond_radps * t_s)) : 0;
    for (int ring = 0; ring < rings; ++ring) {
      const double elevation = up + (ring - (rings - 1) / 2.0) * ring_spacing_deg * kDegree;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const auto hit = caster.cast(world_from_laser.translation(),
                                   (world_from_laser.linear() * direction).normalized(), 30);
      const double noise = noise_m * random.normal();
      const bool dropped = random.uniform() < 0.02;
      // Some return nothing, and drivers leave them out.
      if (!hit || dropped) continue;
      const Eigen::Vector3f p = ((hit->range_m + noise) * direction).cast<float>();
      add(p, since_s, ring);
    }
  }
}

Eigen::Isometry3d walk_in_hall(double t_s) {
  return Eigen::Translation3d(1.5 * std::sin(0.21 * t_s), 1.1 * std::sin(0.17 * t_s + 1) - 0.9,
                              0.1 * std::sin(0.4 * t_s)) *
         Eigen::AngleAxisd(0.35 * std::sin(0.15 * t_s), Eigen::Vector3d::UnitZ());
}

}  // namespace sweepscope::test
