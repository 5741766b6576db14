#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/simulation/typed_simulation.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

// Recordings of slow scanners that tests/benchmark/random_readings draws: 8 to 15 scans a sweep, about a
// vertical axis, of which floor and ceiling say nothing about the offset.
TypedSimulation drawn(std::uint64_t seed, const char* scene, const char* scanner, const char* motor,
                      double sweep_s, double offset_ms) {
  TypedSimulation typed;
  typed.scene = scene;
  typed.scanner = scanner;
  typed.motor = motor;
  typed.axis = "z";
  typed.offset_ms = offset_ms;
  typed.options.seed = seed;
  typed.options.sweep_s = sweep_s;
  return typed;
}

void swings(TypedSimulation& typed, double duration_s, double swing_deg, double middle_deg,
            double encoder_hz) {
  typed.options.duration_s = duration_s;
  typed.options.swing_deg = swing_deg;
  typed.options.motor_middle_deg = middle_deg;
  typed.options.encoder_hz = encoder_hz;
}

// As a rig file that states everything reads it.
Recording stated(const SimulationOptions& options) {
  return assemble(messages_of(simulate(options, Job()).value()), rig_of(options), std::nullopt).value();
}

void expect_answered(const TypedSimulation& typed) {
  const SimulationOptions options = simulation_of(typed).value();
  const Estimate found = test::estimated(stated(options));
  ASSERT_TRUE(found.identifiable) << (found.refusals.empty() ? "" : found.refusals[0].text);
  EXPECT_LT(std::abs(*found.offset_s - options.offset_s), std::max(5 * *found.sigma_s, 0.3 * kMs));
}

TEST(SparseSweeps, BlocksOfFewLinesDoNotMakeTheOffsetChange) {
  TypedSimulation typed = drawn(823, "room-3", "rplidar-a1", "trapezoid", 0.864, 45.068);
  swings(typed, 5.3, 42.5, 3.4, 155);
  expect_answered(typed);
}

TEST(SparseSweeps, TheScatterOfAFewBlocksIsNoDrift) {
  TypedSimulation typed = drawn(211, "room-6", "tim571", "sine", 0.986, 83.095);
  swings(typed, 7.5, 50.6, 7.1, 70);
  expect_answered(typed);
}

TEST(SparseSweeps, AreComparedWithAllOthersWhereNeighboursShowNoValley) {
  TypedSimulation typed = drawn(800, "room-1", "urg04lx", "trapezoid", 0.885, 132.099);
  swings(typed, 5.8, 42.8, 17.6, 131);
  expect_answered(typed);
}

TEST(SparseSweeps, StepsThatAlternateConvergeInTime) {
  TypedSimulation typed = drawn(509, "room-4", "urg04lx", "triangle", 0.811, 158.204);
  swings(typed, 5.3, 71.6, -7.6, 96);
  expect_answered(typed);
}

// Each at an instant of its own: no increment joins them.
TEST(PartsOfTurns, ThatCannotBePutTogetherAreTheReason) {
  TypedSimulation typed;
  typed.scene = "room-6";
  typed.parts = 5;
  typed.beam_times = "instant";
  typed.options.duration_s = 4;
  const Recording recording = stated(simulation_of(typed).value());
  EXPECT_NE(recording.report.warnings.back().find("so they are not put together"), std::string::npos);
  const Estimate found = test::estimated(recording);
  ASSERT_EQ(found.refusals.size(), 1U);
  EXPECT_EQ(found.refusals[0].kind, RefusalKind::kFewSharedSurfaces);
  EXPECT_NE(found.refusals[0].text.find("cover parts of a turn"), std::string::npos)
      << found.refusals[0].text;
}

TEST(PartsOfTurns, TwoBesideABlindSectorAreAnswered) {
  TypedSimulation typed = drawn(1, "room-4", "lms111", "trapezoid", 0.615, -26.893);
  swings(typed, 5, 77.3, -18.9, 175);
  typed.parts = 2;
  expect_answered(typed);
}

}  // namespace
}  // namespace sweepscope
