#include "tests/core/engine_fixtures.hpp"

#include <map>
#include <tuple>

namespace sweepscope::test {

MotorTrack track_of(const std::function<double(double t_s)>& angle_rad, double from_s, double to_s,
                    double rate_hz) {
  MotorTrack track;
  const auto samples = static_cast<int>(std::lround((to_s - from_s) * rate_hz));
  for (int i = 0; i <= samples; ++i) {
    track.time_s.push_back(from_s + i / rate_hz);
    track.angle_rad.push_back(angle_rad(track.time_s.back()));
  }
  return track;
}

const Simulation& simulated(const std::string& scene, double offset_s, double duration_s, double sweep_s) {
  static std::map<std::tuple<std::string, double, double, double>, Simulation> made;
  const std::tuple key(scene, offset_s, duration_s, sweep_s);
  if (const auto found = made.find(key); found != made.end()) return found->second;
  SimulationOptions options;
  options.scene = scene;
  options.offset_s = offset_s;
  options.duration_s = duration_s;
  options.sweep_s = sweep_s;
  return made.emplace(key, simulate(options, Job()).value()).first->second;
}

const Recording& room(double offset_s, double sweep_s) {
  return simulated("room-1", offset_s, 4.5, sweep_s).recording;
}

Estimate estimated(const Recording& recording, const EstimateOptions& options) {
  return estimate(recording, options, Job()).value();
}

void expect_refused(const Estimate& estimate, const std::string& why) {
  EXPECT_FALSE(estimate.identifiable);
  EXPECT_FALSE(estimate.offset_s);
  const auto says = [&](const std::string& reason) { return reason.find(why) != std::string::npos; };
  EXPECT_TRUE(std::ranges::any_of(estimate.reasons(), says))
      << why << " is not in: " << testing::PrintToString(estimate.reasons());
}

Recording Bench::record() const {
  constexpr std::uint32_t kBeams = 721;
  const simulation::Motor motor(simulation::MotorKind::kTriangle, sweep_s, 0.1);
  const simulation::RayCaster caster(mesh);
  Recording recording;
  recording.name = "bench";
  recording.rig.mount = mount;
  recording.motor = track_of([&](double t_s) { return motor.angle_rad(t_s - offset_s); }, offset_s - 0.3,
                             offset_s + duration_s + 0.3);
  for (int i = 0; i < int(duration_s / 0.025); ++i) {
    LaserScan scan{i * 0.025, 1.736e-5, -kPi / 2, kPi / (kBeams - 1), recording.ranges_m.size(), kBeams};
    simulation::Random random(1, 100, std::uint64_t(i));
    for (std::uint32_t beam = 0; beam < kBeams; ++beam)
      recording.ranges_m.push_back(range(caster, motor, scan, beam) + float(noise_m * random.normal()));
    recording.scans.push_back(scan);
  }
  return recording;
}

float Bench::range(const simulation::RayCaster& caster, const simulation::Motor& motor, const LaserScan& scan,
                   std::uint32_t beam) const {
  const Eigen::Vector3d rpy_rad = mount.laser_in_motor_rpy_deg * kDegree;
  const double t_s = scan.beam_s(beam);
  const Eigen::Isometry3d world_from_laser =
      world_from_base(t_s) * Eigen::AngleAxisd(motor.angle_rad(t_s), mount.axis.normalized()) *
      Eigen::Translation3d(mount.laser_in_motor_xyz_m) *
      Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
      Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
      Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
  const double angle_rad = scan.beam_angle_rad(beam);
  const Eigen::Vector3d direction =
      world_from_laser.linear() * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
  const auto hit = caster.cast(world_from_laser.translation(), direction.normalized(), 30);
  return hit ? float(hit->range_m) : std::numeric_limits<float>::quiet_NaN();
}

simulation::Mesh hall() {
  simulation::Mesh mesh = simulation::box({-6, -4, -1.5}, {6, 4, 1.5});
  mesh.add_box({3, 1, -1.5}, {3.6, 1.7, 1.5}).add_box({-3, -2.6, -1.5}, {-2.2, -2, 1.5});
  return mesh.add_box({1.5, -3, -1.5}, {2.8, -2.2, -0.4}).add_box({-4, 2, -1.5}, {-3.2, 3.4, -0.2});
}

OffsetProblem problem_of(const Recording& recording) {
  return problem_for(prepare(recording, FeatureOptions(), Job()).value(), -0.06, 0.06);
}

}  // namespace sweepscope::test
