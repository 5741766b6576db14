#include "core/simulation/simulate.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/sensor.hpp"

namespace sweepscope {
namespace {

using simulation::degrees;
using simulation::radians;
using simulation::Scene;
using simulation::Sensor;
using simulation::Stand;

constexpr std::size_t kBeams = simulation::Scanner{}.beams;

SimulationOptions clean_second() {
  SimulationOptions options;
  options.duration_s = 1.0;
  options.noise_m = 0;
  options.dropout = 0;
  return options;
}

Simulation simulated(const SimulationOptions& options) {
  const Job job;
  return simulate(options, job).value();
}

/// FNV-1a over the bits of a recording.
std::uint64_t digest(const Recording& recording) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  const auto take = [&](std::uint64_t bits) { hash = (hash ^ bits) * 0x100000001b3ULL; };
  for (const LaserScan& scan : recording.scans) take(std::bit_cast<std::uint64_t>(scan.first_beam_s));
  for (const float range_m : recording.ranges_m)
    take(std::isnan(range_m) ? 1 : std::bit_cast<std::uint32_t>(range_m));
  for (const float intensity : recording.intensities) take(std::bit_cast<std::uint32_t>(intensity));
  for (const double time_s : recording.motor.time_s) take(std::bit_cast<std::uint64_t>(time_s));
  for (const double angle_rad : recording.motor.angle_rad) take(std::bit_cast<std::uint64_t>(angle_rad));
  return hash;
}

double mean_difference_m(const Recording& l, const Recording& r) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < l.ranges_m.size(); ++i) {
    if (std::isnan(l.ranges_m[i]) || std::isnan(r.ranges_m[i])) continue;
    sum += l.ranges_m[i] - r.ranges_m[i];
    ++count;
  }
  return sum / count;
}

// Above a bare floor, 1 m high, the beam to the left (+90 deg, the last one) meets the floor at range
// 1 / sin(-phi) when the motor stands at phi < 0: at 2 m for -30 deg. So its range alone tells the motor's
// true angle at the instant of its stamp, and t_motor = t_laser + offset says where the encoder must have
// recorded that angle.
void expect_angles_of_the_floor(SimulationOptions options, int min_compared) {
  options.motor = simulation::MotorKind::kTriangle;
  options.encoder_hz = 1000;
  options.encoder_jitter_s = 0;
  options.encoder_step_deg = 0.01;
  Scene floor{simulation::box({-50, -50, -1}, {50, 50, 0}), Stand{{0, 0, 1}, 0, 0}};
  const Sensor sensor(options, floor);
  const MotorTrack track = sensor.motor_track(1.0);
  int compared = 0;
  for (std::size_t number = 0; number < 40; ++number) {
    std::vector<float> ranges_m(kBeams), intensities(kBeams);
    sensor.cast_turn(number, ranges_m, intensities);
    if (std::isnan(ranges_m.back()) || ranges_m.back() > 4) continue;
    const double stamp_s = sensor.scan(number).last_beam_s();
    const double phi_deg = degrees(-std::asin(1.0 / ranges_m.back()));
    // Near the reversal both directions are at hand, and the range says little.
    if (phi_deg < options.motor_middle_deg - 75) continue;
    EXPECT_NEAR(degrees(track.angle_at(stamp_s + options.offset_s)), phi_deg, 0.2);
    EXPECT_GT(std::abs(degrees(track.angle_at(stamp_s)) - phi_deg), 300 * std::abs(options.offset_s));
    ++compared;
  }
  EXPECT_GE(compared, min_compared);
}

class OffsetsSign : public testing::TestWithParam<double> {};

TEST_P(OffsetsSign, TheEncoderShowsABeamsAngleOneOffsetAfterItsStamp) {
  SimulationOptions options = clean_second();
  options.offset_s = GetParam();
  expect_angles_of_the_floor(options, 8);
}

INSTANTIATE_TEST_SUITE_P(BothSigns, OffsetsSign, testing::Values(0.024, -0.037));

TEST(Simulate, TheMotorSwingsAboutTheMiddleAskedFor) {
  SimulationOptions options = clean_second();
  options.motor_middle_deg = 20;
  const auto& angles_rad = simulated(options).recording.motor.angle_rad;
  const auto [least, most] = std::ranges::minmax(angles_rad);
  EXPECT_NEAR(degrees(least), -70, 1);
  EXPECT_NEAR(degrees(most), 110, 1);
  expect_angles_of_the_floor(options, 4);
}

TEST(Simulate, SameBytesForOneThreadAndMany) {
  SimulationOptions options;
  options.duration_s = 1.0;
  std::uint64_t one = 0;
  {
    const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
    one = digest(simulated(options).recording);
  }
  const tbb::global_control many(tbb::global_control::max_allowed_parallelism, 8);
  EXPECT_EQ(one, digest(simulated(options).recording));
}

// The digest changes with the model alone, not with the instructions that the processor offers.
TEST(Simulate, SameBytesOnEveryMachine) {
  Scene scene;
  scene.mesh.add_box({-8, -6, -0.2}, {8, 6, 0}).add_box({4, -6, 0}, {4.2, 6, 3});
  scene.mesh.add(simulation::prism(6, 0.6, 3), {2, 1, 0, 0});
  scene.mesh.add(simulation::boulder({0.7, 0.5, 0.6}, 0.2, 9), {2, -2, 1, 0});
  scene.motion = Stand{{0.1, 0.2, 1.3}, 5, 2};
  const Sensor sensor(SimulationOptions{}, scene);
  Recording recording;
  recording.ranges_m.resize(8 * kBeams);
  recording.intensities.resize(8 * kBeams);
  for (std::size_t i = 0; i < 8; ++i) {
    sensor.cast_turn(3 * i, std::span(recording.ranges_m).subspan(i * kBeams, kBeams),
                     std::span(recording.intensities).subspan(i * kBeams, kBeams));
    recording.scans.push_back(sensor.scan(i));
  }
  recording.motor = sensor.motor_track(1.0);
  EXPECT_EQ(digest(recording), 843915181117349540ULL);
}

TEST(Simulate, AnotherSeedIsAnotherRecording) {
  SimulationOptions options;
  options.duration_s = 0.5;
  const std::uint64_t first = digest(simulated(options).recording);
  options.seed = 2;
  EXPECT_NE(first, digest(simulated(options).recording));
}

TEST(Simulate, RecordsAtTheRatesOfTheRig) {
  SimulationOptions options = clean_second();
  options.encoder_jitter_s = 0;
  const Recording recording = simulated(options).recording;
  ASSERT_EQ(recording.scans.size(), 40U);
  EXPECT_EQ(recording.scans[7].beams, 721U);
  EXPECT_NEAR(recording.scans[7].first_beam_s, 0.175, 1e-9);
  EXPECT_NEAR(recording.scans[7].time_increment_s, 1.736e-5, 1e-10);
  EXPECT_NEAR(degrees(recording.scans[7].beam_angle_rad(720)), 90, 1e-4);
  EXPECT_NEAR(recording.motor.time_s[9] - recording.motor.time_s[8], 0.01, 2e-9);
  EXPECT_LT(recording.motor.time_s.front(), -0.2);
  EXPECT_GT(recording.motor.time_s.back(), 1.2);
}

TEST(Simulate, RangesAreWholeMillimetresAndAnglesWholeSteps) {
  SimulationOptions options;
  options.duration_s = 0.5;
  const Recording recording = simulated(options).recording;
  std::size_t measured = 0;
  for (const float range_m : recording.ranges_m) {
    if (std::isnan(range_m)) continue;
    ++measured;
    EXPECT_EQ(range_m, static_cast<float>(std::round(range_m * 1e3) / 1e3));
    EXPECT_GE(range_m, 0.1F);
    EXPECT_LE(range_m, 30.0F);
  }
  EXPECT_GT(measured, 10000U);
  for (const double angle_rad : recording.motor.angle_rad) {
    const double steps = degrees(angle_rad) / 0.088;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

TEST(Simulate, TheSkyReturnsNothing) {
  SimulationOptions options = clean_second();
  options.scene = "cemetery";
  const Recording recording = simulated(options).recording;
  const auto none = std::count_if(recording.ranges_m.begin(), recording.ranges_m.end(),
                                  [](float r) { return std::isnan(r); });
  EXPECT_GT(none, std::ssize(recording.ranges_m) / 10);
  EXPECT_LT(none, std::ssize(recording.ranges_m) * 2 / 3);
}

TEST(Simulate, NoiseHasTheDeviationAskedFor) {
  SimulationOptions options = clean_second();
  const Recording exact = simulated(options).recording;
  options.noise_m = 0.02;
  const Recording noisy = simulated(options).recording;
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < exact.ranges_m.size(); ++i) {
    if (std::isnan(exact.ranges_m[i]) || std::isnan(noisy.ranges_m[i])) continue;
    squares += std::pow(noisy.ranges_m[i] - exact.ranges_m[i], 2);
    ++count;
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.001);
}

TEST(Simulate, DropoutsAreAsManyAsAskedFor) {
  SimulationOptions options = clean_second();
  options.dropout = 0.2;
  const Recording recording = simulated(options).recording;
  const auto none = std::count_if(recording.ranges_m.begin(), recording.ranges_m.end(),
                                  [](float r) { return std::isnan(r); });
  EXPECT_NEAR(static_cast<double>(none) / static_cast<double>(recording.ranges_m.size()), 0.2, 0.02);
}

TEST(Simulate, ACutRecordingIsTheBeginningOfTheWholeOne) {
  SimulationOptions options;
  options.duration_s = 0.4;
  const Recording part = simulated(options).recording;
  options.duration_s = 0.8;
  const Recording whole = simulated(options).recording;
  for (std::size_t i = 0; i < part.ranges_m.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(part.ranges_m[i]),
              std::bit_cast<std::uint32_t>(whole.ranges_m[i]));
}

TEST(Simulate, ARoomIsRecordedForFourSecondsAndAHalf) {
  SimulationOptions options;
  const Simulation simulation = simulated(options);
  EXPECT_EQ(simulation.recording.scans.size(), 180U);
  EXPECT_FALSE(simulation.moving);
  EXPECT_EQ(simulation.length_m, 0);
}

TEST(Simulate, FaultsDoWhatTheySay) {
  const Recording exact = simulated(clean_second()).recording;
  SimulationOptions grazing = clean_second();
  grazing.grazing_bias_m = 0.1;
  EXPECT_GT(mean_difference_m(simulated(grazing).recording, exact), 0.005);

  SimulationOptions drifting = clean_second();
  drifting.clock_drift_ppm = 1000;
  EXPECT_NEAR(simulated(drifting).recording.motor.time_s.back() - exact.motor.time_s.back(), 0.0013, 1e-4);

  SimulationOptions jumping = clean_second();
  jumping.jump_s = 0.005;
  jumping.jump_at_s = *jumping.duration_s / 2;
  const MotorTrack jumped = simulated(jumping).recording.motor;
  EXPECT_EQ(jumped.time_s.front(), exact.motor.time_s.front());
  EXPECT_NEAR(jumped.time_s.back() - exact.motor.time_s.back(), 0.005, 1e-8);
  EXPECT_EQ(jumped.angle_rad, exact.motor.angle_rad);

  SimulationOptions jittering = clean_second();
  jittering.stamp_jitter_s = 0.002;
  const Recording jittered = simulated(jittering).recording;
  EXPECT_NE(jittered.scans[5].first_beam_s, exact.scans[5].first_beam_s);
  EXPECT_EQ(mean_difference_m(jittered, exact), 0);

  SimulationOptions nudged = clean_second();
  nudged.nudge_m = 0.05;
  nudged.duration_s = 2.0;
  const Simulation nudge = simulated(nudged);
  EXPECT_NEAR((nudge.truth.back().position_m - nudge.truth.front().position_m).norm(), 0.05, 1e-12);

  SimulationOptions slack = clean_second();
  slack.backlash_deg = 2;
  EXPECT_EQ(simulated(slack).recording.motor.angle_rad, exact.motor.angle_rad);
  EXPECT_NE(mean_difference_m(simulated(slack).recording, exact), 0);
}

TEST(Simulate, StampsThatOvertakeEachOtherAreAllKeptInOrder) {
  SimulationOptions options = clean_second();
  options.duration_s = 4;
  options.encoder_hz = 200;
  const MotorTrack straight = simulated(options).recording.motor;
  options.stamp_jitter_s = 0.004;
  const MotorTrack jittered = simulated(options).recording.motor;
  EXPECT_EQ(jittered.time_s.size(), straight.time_s.size());
  EXPECT_TRUE(std::is_sorted(jittered.time_s.begin(), jittered.time_s.end()));
  double late_s = 0;
  for (std::size_t i = 0; i < straight.time_s.size(); ++i)
    late_s += (jittered.time_s[i] - straight.time_s[i]) / double(straight.time_s.size());
  EXPECT_NEAR(late_s, 0, 4 * 0.004 / std::sqrt(double(straight.time_s.size())));
}

TEST(Simulate, MixedPixelsLieBetweenBothSidesOfAnEdge) {
  SimulationOptions options = clean_second();
  const Recording exact = simulated(options).recording;
  options.mixed_pixels = 1;
  const Recording mixed = simulated(options).recording;
  int between = 0;
  for (std::size_t i = 0; i + 1 < exact.ranges_m.size(); ++i) {
    if (mixed.ranges_m[i] == exact.ranges_m[i]) continue;
    const auto [low, high] = std::minmax(exact.ranges_m[i], exact.ranges_m[i + 1]);
    EXPECT_GT(high - low, 0.19F);
    EXPECT_TRUE(mixed.ranges_m[i] >= low - 0.001F && mixed.ranges_m[i] <= high + 0.001F);
    ++between;
  }
  EXPECT_GT(between, 20);
}

TEST(Simulate, WrongOptionsAreRefusedInOneSentence) {
  const auto refused = [](auto change) {
    SimulationOptions options = clean_second();
    change(options);
    const Job job;
    const auto result = simulate(options, job);
    EXPECT_FALSE(result.has_value());
    if (result) return std::string();
    EXPECT_EQ(result.error().code, ExitCode::kWrongUsage);
    return result.error().message;
  };
  EXPECT_NE(refused([](auto& o) { o.scene = "hall"; }).find("metro-station, parking-area, cemetery"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.noise_m = -0.01; }).find("the noise is -10 mm"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.offset_s = std::nan(""); }).find("the offset"), std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.scene = "cemetery", o.duration_s = 300; }).find("287 s"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) { o.encoder_jitter_s = 0.005; }).find("the encoder's jitter"),
            std::string::npos);
  EXPECT_NE(refused([](auto& o) {
              o.scanner = *simulation::scanner("vlp16");
              o.parts = 2;
            }).find("vlp16 writes clouds"),
            std::string::npos);
}

TEST(Simulate, ACancelledJobIsInterrupted) {
  Job job;
  job.cancel();
  const auto result = simulate(clean_second(), job);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ExitCode::kInterrupted);
}

}  // namespace
}  // namespace sweepscope
