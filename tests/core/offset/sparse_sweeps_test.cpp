#include <gtest/gtest.h>

#include <string>

#include <algorithm>
#include <cmath>

#include "core/offset/estimator.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/simulation/typed_simulation.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/sparse_recording.hpp"

namespace sweepscope {
namespace {

using test::kMs;
using test::typed;

// As a rig file that states everything reads it.
Recording stated(const SimulationOptions& options) {
  return assemble(messages_of(simulate(options, Job()).value()), rig_of(options), std::nullopt).value();
}

void expect_answered(const TypedSimulation& simulation) {
  const SimulationOptions options = simulation_of(simulation).value();
  const Estimate found = test::estimated(stated(options));
  ASSERT_TRUE(found.identifiable) << (found.refusals.empty() ? "" : found.refusals[0].text);
  EXPECT_LT(std::abs(*found.offset_s - options.offset_s), std::max(5 * *found.sigma_s, 0.3 * kMs));
}

TEST(SparseSweeps, BlocksOfFewLinesDoNotMakeTheOffsetChange) {
  expect_answered(typed({823, "room-3", "rplidar-a1", "trapezoid", 0.864, 45.068, 5.3, 42.5, 3.4, 155}));
}

TEST(SparseSweeps, TheScatterOfAFewBlocksIsNoDrift) {
  expect_answered(typed({24, "room-1", "urg04lx", "trapezoid", 0.904, 106.377, 8.0, 75.5, 8.3, 159}));
}

TEST(SparseSweeps, AreComparedWithAllOthersWhereNeighboursShowNoValley) {
  expect_answered(typed({800, "room-1", "urg04lx", "trapezoid", 0.885, 132.099, 5.8, 42.8, 17.6, 131}));
}

TEST(SparseSweeps, StepsThatAlternateConvergeInTime) {
  expect_answered(typed({509, "room-4", "urg04lx", "triangle", 0.811, 158.204, 5.3, 71.6, -7.6, 96}));
}

// Neither axis fits a walk, and the wrong one may have the shorter distances.
// A walk in a world, as a scanner with 15 Hz records it.
TypedSimulation walk_in(const std::string& world, double sweep_s, double offset_ms) {
  TypedSimulation walk;
  walk.world = world;
  walk.walk = "brisk" + world.substr(world.find(':'));
  walk.scanner = "tim571";
  walk.offset_ms = offset_ms;
  walk.options.sweep_s = sweep_s;
  walk.options.duration_s = 45;
  return walk;
}

void expect_no_other_axis(const TypedSimulation& walk) {
  SimulationOptions options = simulation_of(walk).value();
  Rig unknown = rig_of(options);
  unknown.mount = {};
  const Recording recording =
      window(assemble(messages_of(simulate(options, Job()).value()), unknown, std::nullopt).value(), 0, 12);
  EXPECT_FALSE(rank_readings(recording, Job()).axis_is_found);
}

// In a corridor sweeps about the wrong axis lie within the range noise of each other, and 29 scans a sweep
// show the motion.
TEST(DenseSweeps, OfAWalkInACorridorDoNotShowAnotherAxis) {
  TypedSimulation walk = walk_in("corridor:20003", 0.729, -0.33);
  walk.walk = "wild:20003";
  walk.scanner = "utm30lx";
  walk.options.seed = 20003;
  walk.options.duration_s = 6;
  expect_no_other_axis(walk);
}

TEST(SparseSweeps, OfAWalkDoNotShowAnotherAxis) {
  TypedSimulation walk = walk_in("car-park:31007", 0.535, 32.34);
  walk.motor = "triangle";
  walk.options.seed = 31007;
  walk.options.duration_s = 50;
  expect_no_other_axis(walk);
}

// About y the distances are half as long as the range noise, and only about x do sweeps show the motion.
TEST(SparseSweeps, OfAWalkWhoseDistancesAreShortDoNotShowAnotherAxis) {
  expect_no_other_axis(walk_in("street:53003", 0.641, 12));
}

// The coarse search of the default window has its minimum at 60 ms, inside; the least squares ends beyond.
TEST(SparseSweeps, AnOffsetBesideTheEndOfTheDefaultWindowIsFound) {
  expect_answered(
      typed({10215, "room-3", "urg04lx", "trapezoid", 0.812, 61.4, 7.1, 88.8, -8.5, 80, "instant"}));
}

// 8.5 scans a sweep: every second sweep of a direction measures the same lines, and errs as the one before.
TEST(SparseSweeps, SweepsThatRepeatTheirLinesDoNotMakeTheOffsetCertain) {
  TypedSimulation repeating =
      typed({12210, "room-1", "urg04lx", "trapezoid", 0.85, -184.212, 5.3, 37.4, 10.8, 31});
  repeating.axis = "x";
  repeating.motor_repeats = 3;
  expect_answered(repeating);
}

// Each pair of sweeps gains 2 to 8 matches by a shift of 3 to 10 mm.
TEST(SparseSweeps, ShiftsAsShortAsTheirNoiseAreNoMotion) {
  TypedSimulation simulation =
      typed({18254, "room-1", "ld19", "trapezoid", 0.802, 108.981, 5.3, 40.7, -7.7, 140, "instant"});
  simulation.axis = "z";
  expect_answered(simulation);
}

// 14 deg apart: beside the lines of one direction those of the other say little about its surfaces.
TEST(SparseSweeps, LinesFarApartAreTheReason) {
  const Estimate found =
      test::estimated(stated(simulation_of(typed({9367, "room-3", "rplidar-s2", "trapezoid", 1.201, -62.639,
                                                  7.4, 80.2, 11.9, 120, "instant"}))
                                 .value()));
  ASSERT_EQ(found.refusals.size(), 1U);
  EXPECT_EQ(found.refusals[0].kind, RefusalKind::kLinesTooFarApart);
  EXPECT_NE(found.refusals[0].text.find("14 deg of the motor's angle"), std::string::npos)
      << found.refusals[0].text;
}

TEST(SparseSweeps, ThatDoNotMatchMayBeTooFewToCompare) {
  const Estimate found = test::estimated(stated(
      simulation_of(typed({622, "room-1", "rplidar-a1", "sine", 0.883, -136.487, 5.3, 77.5, -13.8, 165}))
          .value()));
  ASSERT_EQ(found.refusals.size(), 1U);
  EXPECT_NE(found.refusals[0].text.find("too few to compare"), std::string::npos) << found.refusals[0].text;
}

// Each at an instant of its own: no increment joins them.
TEST(PartsOfTurns, ThatCannotBePutTogetherAreTheReason) {
  TypedSimulation parts;
  parts.scene = "room-6";
  parts.parts = 5;
  parts.beam_times = "instant";
  parts.options.duration_s = 4;
  const Recording recording = stated(simulation_of(parts).value());
  EXPECT_NE(recording.report.warnings.back().find("so they are not put together"), std::string::npos);
  const Estimate found = test::estimated(recording);
  ASSERT_EQ(found.refusals.size(), 1U);
  EXPECT_EQ(found.refusals[0].kind, RefusalKind::kFewSharedSurfaces);
  EXPECT_NE(found.refusals[0].text.find("cover parts of a turn"), std::string::npos)
      << found.refusals[0].text;
}

TEST(PartsOfTurns, TwoBesideABlindSectorAreAnswered) {
  TypedSimulation parts = typed({1, "room-4", "lms111", "trapezoid", 0.615, -26.893, 5, 77.3, -18.9, 175});
  parts.parts = 2;
  expect_answered(parts);
}

}  // namespace
}  // namespace sweepscope
