#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <array>
#include <cmath>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/scenes/glass.hpp"
#include "core/simulation/scenes/people.hpp"
#include "core/simulation/sensor.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope {
namespace {

using simulation::box;
using simulation::degrees;
using simulation::Glass;
using simulation::Mesh;
using simulation::Motor;
using simulation::MotorKind;
using simulation::Person;
using simulation::place_people;
using simulation::radians;
using simulation::RayCaster;
using simulation::Scene;
using simulation::Sensor;
using simulation::Stand;
using simulation::Vector3d;

constexpr std::size_t kBeamsATurn = simulation::Scanner{}.beams;
constexpr std::size_t kForward = 360, kLeft = 720, kRight = 0;  // beams

SimulationOptions clean() {
  SimulationOptions options;
  options.noise_m = 0;
  options.dropout = 0;
  options.encoder_jitter_s = 0;
  options.encoder_step_deg = 1e-6;
  return options;
}

/// The rig stands in the origin, 4 m before a wall; the other walls are `half_m` away.
Scene room(double half_m) {
  return {box({-half_m, -half_m, -half_m}, {4, half_m, half_m}), Stand{}};
}

/// The ranges of one scan; the scans differ in the motor's angle.
std::array<float, kBeamsATurn> scan_of(const SimulationOptions& options, const Scene& scene,
                                       std::size_t number = 0) {
  std::array<float, kBeamsATurn> ranges_m{}, intensities{};
  Sensor(options, scene).cast_turn(number, ranges_m, intensities);
  return ranges_m;
}

TEST(Faults, AYawOfTheMountLengthensTheForwardBeam) {
  SimulationOptions options = clean();
  EXPECT_FLOAT_EQ(scan_of(options, room(20))[kForward], 4);
  options.mount_error_deg = {0, 0, 10};
  for (const std::size_t number : {0, 3, 7})  // whatever the motor does: the beam stays on a cone
    EXPECT_NEAR(scan_of(options, room(20), number)[kForward], 4 / std::cos(radians(10)), 6e-4);
  options.mount_error_deg = {0, -8, 0};
  EXPECT_NEAR(scan_of(options, room(20))[kForward], 4 / std::cos(radians(8)), 6e-4);
}

// The beam at 10 deg to the left looks straight ahead where the laser is turned to the right by as much.
TEST(Faults, AMountTurnedRightMovesTheForwardBeamLeft) {
  SimulationOptions options = clean();
  options.mount_error_deg = {0, 0, -10};
  EXPECT_FLOAT_EQ(scan_of(options, room(20))[kForward + 40], 4);
}

TEST(Faults, AMountsRollIsAnAngleThatTheEncoderDoesNotShow) {
  SimulationOptions options = clean();
  options.motor = MotorKind::kStuck;
  const Scene scene = {box({-50, -50, -1}, {50, 50, 30}), Stand{{0, 0, 0}, 0, 0}};
  const Sensor straight(options, scene);
  const double angle_rad = straight.motor_track(1).angle_rad.front();
  options.mount_error_deg = {7, 0, 0};
  EXPECT_EQ(Sensor(options, scene).motor_track(1).angle_rad.front(), angle_rad);
  // The left beam goes down where the laser is turned below 0, the right one where it is turned above.
  const double down = std::sin(angle_rad + radians(7));
  ASSERT_GT(std::abs(down), 0.1);
  EXPECT_NEAR(scan_of(options, scene)[down < 0 ? kLeft : kRight], 1 / std::abs(down), 2e-3);
}

TEST(Faults, AMountOffTheAxisShortensTheBeamsThatPointThere) {
  SimulationOptions options = clean();
  options.mount_error_m = {0.1, 0, 0};
  EXPECT_FLOAT_EQ(scan_of(options, room(20))[kForward], 3.9F);
  options.mount_error_m = {0, 0.2, 0};
  for (const std::size_t number : {0, 3, 7}) {
    const auto off = scan_of(options, room(20), number), on = scan_of(clean(), room(20), number);
    EXPECT_NEAR(off[kLeft], on[kLeft] - 0.2, 1.1e-3);
    EXPECT_NEAR(off[kRight], on[kRight] + 0.2, 1.1e-3);
    EXPECT_FLOAT_EQ(off[kForward], 4);
  }
}

TEST(Faults, AnEccentricEncoderShowsItsFirstHarmonic) {
  SimulationOptions options = clean();
  const MotorTrack round = Sensor(options, room(20)).motor_track(2);
  options.eccentricity_deg = 1.5;
  options.eccentricity_phase_deg = 40;
  const MotorTrack eccentric = Sensor(options, room(20)).motor_track(2);
  ASSERT_EQ(round.angle_rad.size(), eccentric.angle_rad.size());
  for (std::size_t i = 0; i < round.angle_rad.size(); ++i)
    ASSERT_NEAR(degrees(eccentric.angle_rad[i] - round.angle_rad[i]),
                1.5 * std::sin(round.angle_rad[i] + radians(40)), 1e-5);
  EXPECT_EQ(scan_of(options, room(20)), scan_of(clean(), room(20)));  // the laser turns as before
}

TEST(Faults, AnUnevenMotorVariesItsSpeedByAtMostThePartSaid) {
  const Motor even(MotorKind::kOneWay, 0.5, 0.1), uneven(MotorKind::kOneWay, 0.5, 0.1, {0.2, 3});
  double most = 0;
  for (double t_s = 0; t_s < 30; t_s += 0.01) {
    const double speed = uneven.angle_rad(t_s + 0.01) - uneven.angle_rad(t_s);
    const double part = speed / (even.angle_rad(t_s + 0.01) - even.angle_rad(t_s)) - 1;
    ASSERT_LE(std::abs(part), 0.2 + 1e-9);
    most = std::max(most, std::abs(part));
  }
  EXPECT_GT(most, 0.05);
  const Motor other(MotorKind::kOneWay, 0.5, 0.1, {0.2, 4});
  EXPECT_NE(other.angle_rad(2), uneven.angle_rad(2));
}

TEST(Faults, NoiseGrowsWithRange) {
  SimulationOptions options = clean();
  options.noise_m = 0.01;
  options.noise_per_m = 0.005;
  double squares = 0, count = 0;
  for (std::size_t number = 0; number < 10; ++number) {
    const auto exact = scan_of(clean(), room(6), number), noisy = scan_of(options, room(6), number);
    for (std::size_t beam = 0; beam < kBeamsATurn; ++beam, ++count)
      squares += std::pow((noisy[beam] - exact[beam]) / (0.01 + 0.005 * exact[beam]), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / count), 1, 0.03);
}

TEST(Faults, GrazingBeamsAreDroppedTheMoreTheMoreTheyGraze) {
  SimulationOptions options = clean();
  options.grazing_dropout = 0.8;
  const Scene wall = {box({4, -1000, -1000}, {5, 1000, 1000}, 0.5), Stand{}};
  const Sensor sensor(options, wall);
  int square = 0, at_60_deg = 0;
  constexpr int kScans = 600;
  for (std::size_t number = 0; number < kScans; ++number) {
    std::array<float, kBeamsATurn> ranges_m{}, intensities{};
    sensor.cast_turn(number, ranges_m, intensities);
    square += std::isnan(ranges_m[kForward]);
    at_60_deg += std::isnan(ranges_m[kForward + 240]);
  }
  EXPECT_EQ(square, 0);
  EXPECT_NEAR(at_60_deg, 0.8 * 0.5 * kScans, 4 * std::sqrt(0.24 * kScans));  // 1 - cos(60 deg) = 1/2
}

TEST(Faults, DarkSurfacesLoseBeamsThatMeetThemSquarely) {
  SimulationOptions options = clean();
  options.grazing_dropout = 1;
  const Sensor sensor(options, {box({4, -9, -9}, {5, 9, 9}, 0.1), Stand{}});
  int lost = 0;
  for (std::size_t number = 0; number < 400; ++number) {
    std::array<float, kBeamsATurn> ranges_m{}, intensities{};
    sensor.cast_turn(number, ranges_m, intensities);
    lost += std::isnan(ranges_m[kForward]);
  }
  EXPECT_NEAR(lost, 0.8 * 400, 4 * std::sqrt(0.16 * 400));
}

TEST(People, AreMetAtTheirSideAndAtTheirTop) {
  const Person person{{0, 0}, 1, 0, false, 0.5};  // at (1, 0) first, from 0.5 to 2.25 m
  const auto side = person.cast({5, 0, 1}, {-1, 0, 0}, 0);
  ASSERT_TRUE(side);
  EXPECT_NEAR(side->range_m, 3.75, 1e-12);
  EXPECT_NEAR(side->cos_incidence, 1, 1e-12);
  const auto top = person.cast({1, 0.1, 4}, {0, 0, -1}, 0);
  ASSERT_TRUE(top);
  EXPECT_NEAR(top->range_m, 1.75, 1e-12);
  EXPECT_FALSE(person.cast({5, 0, 2.3}, {-1, 0, 0}, 0));   // above the head
  EXPECT_FALSE(person.cast({5, 0, 0.4}, {-1, 0, 0}, 0));   // below the feet
  EXPECT_FALSE(person.cast({5, 0.26, 1}, {-1, 0, 0}, 0));  // past the shoulder
  EXPECT_FALSE(person.cast({5, 0, 1}, {1, 0, 0}, 0));      // behind
}

TEST(People, WalkAtOneMetrePerSecond) {
  const Person person{{2, 3}, 1.5, 0.7, true, 0};
  EXPECT_NEAR((person.at(4.001) - person.at(4)).norm(), 0.001, 1e-9);
  EXPECT_NEAR((person.at(9) - person.middle_m).norm(), 1.5, 1e-12);
}

TEST(People, KeepAwayFromWallsAndFromTheRig) {
  Mesh hall = box({-8, -8, 0}, {8, 8, 3});
  hall.add_box({2, 2, 0}, {3, 3, 0.8});  // a table
  const RayCaster scene(hall);
  const auto rig_at = [](double t_s) { return Vector3d(0.2 * t_s, 0, 1.5); };
  const auto people = place_people(5, 1, scene, rig_at, 10);
  ASSERT_TRUE(people);
  ASSERT_EQ(people->size(), 5U);
  for (const Person& person : *people) {
    EXPECT_NEAR(person.floor_m, 0, 1e-9);
    for (double t_s = 0; t_s < 10; t_s += 0.05) {
      EXPECT_GT((person.at(t_s) - rig_at(t_s).head<2>()).norm(), 0.7);
      EXPECT_FALSE(scene.distance_m({person.at(t_s).x(), person.at(t_s).y(), 0.6}, 0.19));
    }
  }
}

TEST(People, AreRefusedWhereThereIsNoRoom) {
  const auto people = place_people(
      1, 1, RayCaster(box({-1, -1, 0}, {1, 1, 3})), [](double) { return Vector3d(0, 0, 1); }, 1);
  ASSERT_FALSE(people);
  EXPECT_EQ(people.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(people.error().message.find("no room for person 1 of 1"), std::string::npos);
}

// An upright pane at x = 2, and behind it a slope that cannot be glass.
TEST(Glass, LetsNineBeamsOfTenThrough) {
  Mesh mesh;
  mesh.add_polygon(std::array<Vector3d, 4>{{{2, -5, -5}, {2, 5, -5}, {2, 5, 5}, {2, -5, 5}}}, 0.5);
  mesh.add_polygon(std::array<Vector3d, 4>{{{2.5, -9, -3}, {2.5, 9, -3}, {9, 9, 3}, {9, -9, 3}}}, 0.9);
  const RayCaster scene(mesh);
  const Glass all(1, 7), none(0, 7);
  int behind = 0, nothing = 0;
  for (std::uint64_t beam = 0; beam < 2000; ++beam) {
    const auto end = all.cast(scene, {0, 0, 0}, {1, 0, 0}, 30, beam);
    if (end.hit) {
      EXPECT_NEAR(end.range_m, 5.75, 1e-9);
    }
    behind += end.hit.has_value();
    nothing += !end.hit && end.range_m == 2;
    EXPECT_EQ(none.cast(scene, {0, 0, 0}, {1, 0, 0}, 30, beam).range_m, 2);
  }
  EXPECT_EQ(behind + nothing, 2000);
  EXPECT_NEAR(behind, 1800, 4 * std::sqrt(180.0));
}

TEST(Glass, CoversThePartOfTheSurfacesAskedFor) {
  Mesh mesh;
  mesh.add_polygon(std::array<Vector3d, 4>{{{2, -50, -50}, {2, 50, -50}, {2, 50, 50}, {2, -50, 50}}}, 0.5);
  const RayCaster scene(mesh);
  const Glass glass(0.3, 7);
  int panes = 0;
  for (int y = 0; y < 60; ++y)
    for (int z = 0; z < 60; ++z) panes += !glass.cast(scene, {0, y - 30.0, z - 30.0}, {1, 0, 0}, 5, 0).hit;
  EXPECT_NEAR(panes, 0.3 * 3600, 4 * std::sqrt(0.21 * 3600));
}

TEST(Faults, AllAtOnceAreTheSameForOneThreadAndMany) {
  SimulationOptions options;
  options.scene = "room-2";
  options.duration_s = 1;
  options.noise_per_m = 0.002;
  options.grazing_dropout = 0.5;
  options.mount_error_deg = {0.5, -0.3, 0.2};
  options.mount_error_m = {0.01, 0.02, 0.03};
  options.eccentricity_deg = 0.4;
  options.uneven_motor = 0.05;
  options.people = 1;
  options.glass = 0.2;
  const Job job;
  const auto recorded = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return simulate(options, job).value().recording;
  };
  const Recording one = recorded(1), two = recorded(2);
  ASSERT_EQ(one.ranges_m.size(), two.ranges_m.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < one.ranges_m.size(); ++i)
    different +=
        std::isnan(one.ranges_m[i]) ? !std::isnan(two.ranges_m[i]) : one.ranges_m[i] != two.ranges_m[i];
  EXPECT_EQ(different, 0U);
  EXPECT_EQ(one.intensities, two.intensities);
  EXPECT_EQ(one.motor.angle_rad, two.motor.angle_rad);
  EXPECT_EQ(one.motor.time_s, two.motor.time_s);
}

TEST(Faults, WrongValuesAreRefusedByName) {
  const auto refused = [](auto change) {
    SimulationOptions options = clean();
    options.duration_s = 0.2;
    change(options);
    const Job job;
    const auto result = simulate(options, job);
    EXPECT_FALSE(result.has_value());
    return result ? std::string() : result.error().message;
  };
  EXPECT_NE(refused([](auto& o) { o.mount_error_deg.y() = 11; }).find("the mount's pitch error is 11 deg"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.glass = std::nan(""); }).find("the fraction of glass"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.uneven_motor = 0.6; }).find("the unevenness of the motor is 0.6"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.people = 51; }).find("the number of people is 51"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
