#include "core/rig_solve/rig_solve.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/io/trajectory_file.hpp"
#include "core/offset/estimator.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/scene_mesh.hpp"
#include "tests/scratch_folder.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kOffset_s = 0.017;

SimulationOptions rig_in_room(simulation::MotorKind motor = simulation::MotorKind::kTriangle) {
  SimulationOptions options;
  options.scene = "room-2";
  options.offset_s = kOffset_s;
  options.duration_s = 8;
  options.motor = motor;
  return options;
}

const Recording& perfect_rig() {
  static const Recording recording = simulate(rig_in_room(), Job()).value().recording;
  return recording;
}

SimulationOptions walk_with_turned_mount() {
  SimulationOptions options;
  options.scene = "metro-station";
  options.offset_s = kOffset_s;
  options.duration_s = 14;
  options.mount_error_deg = {0, 1.2, -0.9};
  return options;
}

const Recording& turned_walk() {
  static const Recording recording = simulate(walk_with_turned_mount(), Job()).value().recording;
  return recording;
}

// Between the directions of the motor's axis as the laser has them: what a turn about the axis leaves alone.
double axis_apart_deg(const Eigen::Vector3d& rpy_deg, const Eigen::Vector3d& other_rpy_deg) {
  const Eigen::Vector3d a = rotation_from_rpy(rpy_deg).conjugate() * Eigen::Vector3d::UnitX(),
                        b = rotation_from_rpy(other_rpy_deg).conjugate() * Eigen::Vector3d::UnitX();
  return std::asin(a.cross(b).norm()) * kDegPerRad;
}

Estimate solved(const Recording& recording, const RigSolve& what) {
  EstimateOptions options;
  options.solve = what;
  return estimate(recording, options, Job()).value();
}

TEST(RigSolve, FindsAMountThatIsDegreesAndCentimetresOff) {
  SimulationOptions options = rig_in_room();
  options.mount_error_deg = {0, -6, 7};
  options.mount_error_m = {0, 0.12, -0.1};
  const Estimate found = solved(simulate(options, Job()).value().recording, {.mount = true});
  ASSERT_TRUE(found.identifiable);
  ASSERT_TRUE(found.rig->mount.identifiable);
  const Mount& mount = found.rig->rig.mount;
  EXPECT_LT(axis_apart_deg(mount.laser_in_motor_rpy_deg, options.mount_error_deg), 0.02);
  EXPECT_LT((mount.laser_in_motor_rpy_deg - options.mount_error_deg).norm(), 0.02);
  EXPECT_LT((mount.laser_in_motor_xyz_m - options.mount_error_m).norm(), 0.001);
  EXPECT_NEAR(*found.offset_s, kOffset_s, 0.03 * kMs);
  EXPECT_LT(std::abs(*found.offset_s - kOffset_s), 3 * *found.sigma_s);
}

TEST(RigSolve, PlayOfASineMotorIsFound) {
  SimulationOptions options = rig_in_room(simulation::MotorKind::kSine);
  options.backlash_deg = 0.3;
  const Estimate found = solved(simulate(options, Job()).value().recording, {.play = true});
  ASSERT_TRUE(found.identifiable);
  ASSERT_TRUE(found.rig->play.identifiable) << found.rig->play.reason;
  EXPECT_NEAR(found.rig->rig.gear.play_deg, 0.3, 0.05);
  EXPECT_LT(std::abs(*found.offset_s - kOffset_s), 3 * *found.sigma_s);
}

TEST(RigSolve, PlayAtOneSpeedIsNotIdentifiableAndSigmaCoversIt) {
  SimulationOptions options = rig_in_room();
  options.backlash_deg = 0.4;
  const Estimate found = solved(simulate(options, Job()).value().recording, {.play = true});
  ASSERT_TRUE(found.identifiable);
  EXPECT_FALSE(found.rig->play.identifiable);
  EXPECT_NE(found.rig->play.reason.find("one speed"), std::string::npos) << found.rig->play.reason;
  EXPECT_GT(std::abs(*found.offset_s - kOffset_s), 0.3 * kMs);  // as play does
  EXPECT_LT(std::abs(*found.offset_s - kOffset_s), 3 * *found.sigma_s);
}

TEST(RigSolve, AnEccentricEncoderIsFound) {
  SimulationOptions options = rig_in_room();
  options.eccentricity_deg = 0.4;
  options.eccentricity_phase_deg = 50;
  const Estimate found = solved(simulate(options, Job()).value().recording, {.encoder = true});
  ASSERT_TRUE(found.rig->encoder.identifiable) << found.rig->encoder.reason;
  const Eigen::Vector2d truth_rad = Rig::Gear{0, 0.4, 50}.angles().encoder_rad;
  EXPECT_LT((found.rig->rig.gear.angles().encoder_rad - truth_rad).norm() * kDegPerRad, 0.05);
}

// A prior that is too narrow is named as a possible reason, and a narrow one of the mount is no reason.
TEST(RigSolve, AnEncoderFarBeyondItsPriorIsLeftAsItWas) {
  SimulationOptions options = rig_in_room();
  options.eccentricity_deg = 0.5;
  const Recording recording = simulate(options, Job()).value().recording;
  const Estimate narrow = solved(recording, {.encoder = true, .encoder_deg = 0.05});
  ASSERT_TRUE(narrow.rig);
  EXPECT_FALSE(narrow.rig->encoder.identifiable);
  EXPECT_NE(narrow.rig->encoder.reason.find("the prior is too narrow"), std::string::npos)
      << narrow.rig->encoder.reason;
  options.mount_error_deg = {0, 1, -1};
  const Estimate of_mount = solved(simulate(options, Job()).value().recording,
                                   {.mount = true, .encoder = true, .mount_deg = 0.2, .mount_mm = 10});
  ASSERT_TRUE(of_mount.rig);
  EXPECT_TRUE(of_mount.rig->encoder.identifiable) << of_mount.rig->encoder.reason;
}

TEST(RigSolve, AMountIsSolvedForWithTheGivenEncoderUnlessTheSurfacesShowAnother) {
  SimulationOptions options = rig_in_room();
  options.mount_error_m = {0, 0.03, -0.02};
  const auto shift_error_m = [&](const Estimate& found) {
    return (found.rig->rig.mount.laser_in_motor_xyz_m - options.mount_error_m).norm();
  };
  const Estimate perfect = solved(simulate(options, Job()).value().recording, {.mount = true});
  EXPECT_EQ(perfect.rig->encoder.reason, "");
  EXPECT_LT(shift_error_m(perfect), 0.001);
  options.eccentricity_deg = 0.3;
  options.eccentricity_phase_deg = 50;
  const Estimate eccentric = solved(simulate(options, Job()).value().recording, {.mount = true});
  EXPECT_NE(eccentric.rig->encoder.reason.find("eccentric encoder, by 0.3"), std::string::npos)
      << eccentric.rig->encoder.reason;
  EXPECT_EQ(eccentric.rig->rig.gear.encoder_amplitude_deg, 0);
  EXPECT_LT(shift_error_m(eccentric), 0.001);
}

// Where hardly more than the ground is in view, degrees of an encoder and decimetres of a shift cancel.
TEST(RigSolve, AnEncoderThatTheGroundCannotTellIsLeftAsItWas) {
  const test::ScratchFolder folder;
  test::write_scene_mesh("cemetery", folder / "cemetery.ply");
  SimulationOptions options = rig_in_room();
  options.own.mesh = folder / "cemetery.ply";
  options.own.placement.at_m = {2.4, -1, 1.5};
  options.sweep_s = 0.9;
  options.mount_error_deg = {0, -3, 2};
  options.mount_error_m = {0, 0.08, 0.11};
  const Recording recording = simulate(options, Job()).value().recording;
  for (const bool encoder : {false, true}) {
    const Estimate found = solved(recording, {.mount = true, .encoder = encoder});
    ASSERT_TRUE(found.rig && found.rig->mount.identifiable);
    EXPECT_FALSE(found.rig->encoder.identifiable);
    EXPECT_EQ(found.rig->encoder.reason.find("Surfaces are flatter"), std::string::npos);
    const Mount& mount = found.rig->rig.mount;
    EXPECT_LT((mount.laser_in_motor_rpy_deg - options.mount_error_deg).norm(), 0.05);
    EXPECT_LT((mount.laser_in_motor_xyz_m - options.mount_error_m).norm(), 0.003);
    // Named, the encoder may be off by its prior of 1 deg, and with it the shift.
    const double shift_m = std::sqrt(found.rig->covariance.block<2, 2>(kShiftU, kShiftU).trace());
    EXPECT_GT(shift_m, encoder ? 0.01 : 0.003);
    EXPECT_LT(shift_m, encoder ? 0.04 : 0.015);
  }
}

TEST(RigSolve, AWrongMountIsWarnedOfAndAPerfectRigIsNot) {
  const auto warned = [](const Recording& recording) {
    const Estimate found = estimate(recording, {}, Job()).value();
    EXPECT_TRUE(found.rig_effects && found.rig_effects->mount_tilt_s_rad);
    return std::ranges::any_of(found.warnings, [](const std::string& warning) {
      return warning.find("--solve offset,mount") != std::string::npos;
    });
  };
  EXPECT_FALSE(warned(perfect_rig()));
  SimulationOptions options = rig_in_room();
  options.mount_error_deg = {0, 0.6, -0.8};
  EXPECT_TRUE(warned(simulate(options, Job()).value().recording));
}

TEST(RigSolve, APerfectRigIsFoundToBeOne) {
  const Estimate found = solved(perfect_rig(), {.mount = true, .encoder = true});
  const RigVector x = found.rig->found.vector();
  for (int i = kTurnU; i < kRigUnknowns; ++i)
    EXPECT_LT(std::abs(x[i]), 3.5 * std::sqrt(found.rig->covariance(i, i)) + 1e-12) << i;
}

TEST(RigSolve, WithoutAnySurfaceNothingIsIdentifiable) {
  const PreparedRecording prepared = prepare(perfect_rig(), FeatureOptions(), Job()).value();
  OffsetProblem problem = problem_for(prepared, kOffset_s, kOffset_s);
  std::ranges::fill(problem.scan_used, 0);
  const SolvedRig found =
      solve_rig({&problem, 1}, {.offset_s = kOffset_s}, {.mount = true, .encoder = true}, Job());
  EXPECT_FALSE(found.mount.identifiable);
  EXPECT_FALSE(found.encoder.identifiable);
}

TEST(RigSolve, IsTheSameForAnyNumberOfThreads) {
  RigVector found[2];
  for (const int threads : {1, 2}) {
    const tbb::global_control limited(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    found[threads - 1] = solved(perfect_rig(), {.mount = true}).rig->found.vector();
  }
  EXPECT_EQ(found[0], found[1]);
}

TEST(RigSolve, AWalkTellsHowTheMountIsTurnedAndNothingElse) {
  const SimulationOptions simulated = walk_with_turned_mount();
  const Estimate found = solved(turned_walk(), {.mount = true, .play = true, .encoder = true});
  ASSERT_TRUE(found.identifiable) << testing::PrintToString(found.reasons());
  ASSERT_TRUE(found.rig && found.rig->along_walk);
  ASSERT_TRUE(found.rig->mount.identifiable);
  EXPECT_FALSE(found.rig->play.identifiable);
  EXPECT_FALSE(found.rig->encoder.identifiable);
  const Mount &given = found.rig->given.mount, &mount = found.rig->rig.mount;
  EXPECT_LT(axis_apart_deg(mount.laser_in_motor_rpy_deg, simulated.mount_error_deg), 0.3);
  EXPECT_GT(axis_apart_deg(given.laser_in_motor_rpy_deg, simulated.mount_error_deg), 1.4);
  EXPECT_EQ(mount.laser_in_motor_xyz_m, given.laser_in_motor_xyz_m);
  EXPECT_TRUE(found.rig->converged);
  RigMatrix alone = found.rig->covariance;  // what is not determined has nothing to do with the rest
  alone.block<2, 2>(kTurnU, kTurnU).setZero();
  EXPECT_TRUE(alone.isDiagonal());
  EXPECT_LT(std::abs(*found.offset_s - kOffset_s), 3 * *found.sigma_s);
}

// The rig stands for 8 s, then walks: what the walk does not tell is found from the part before it.
SimulationOptions walk_that_begins_standing(const test::ScratchFolder& folder) {
  test::write_scene_mesh("metro-station", folder / "station.ply");
  std::vector<StampedPose> poses;
  for (double t_s = 0; t_s < 16; t_s += 0.05) {
    const double walked_s = std::max(0.0, t_s - 8), s = walked_s * walked_s / (1 + walked_s);
    poses.push_back({t_s,
                     {0.5 * std::sin(0.8 * s), 0.25 * (1 - std::cos(0.8 * s)), 0.05 * std::sin(3 * s)},
                     rotation_from_vector({0.03 * std::sin(2.3 * s), 0, 0.6 * std::sin(0.5 * s)})});
  }
  EXPECT_TRUE(write_tum(folder / "walk.tum", poses));
  SimulationOptions simulated;
  simulated.own = {folder / "station.ply", folder / "walk.tum", {}, 0};
  simulated.own.placement.at_m = {0.4, -4.4, 1.5};
  simulated.offset_s = kOffset_s;
  simulated.mount_error_deg = {0, 1.2, -0.9};
  simulated.mount_error_m = {0, 0.02, 0.01};
  return simulated;
}

void expect_mount_of_standing_part(const SimulationOptions& simulated) {
  const auto recorded = simulate(simulated, Job());
  ASSERT_TRUE(recorded) << recorded.error().message;
  const Estimate found = solved(recorded->recording, {.mount = true});
  EXPECT_EQ(found.kind, RigKind::kMoving);
  EXPECT_NE(found.kind_reason.find("The rig was solved for from 0.0 to "), std::string::npos)
      << found.kind_reason;
  ASSERT_TRUE(found.rig && !found.rig->along_walk && found.rig->mount.identifiable);
  const Mount& mount = found.rig->rig.mount;
  EXPECT_LT((mount.laser_in_motor_rpy_deg - simulated.mount_error_deg).norm(), 0.05);
  EXPECT_LT((mount.laser_in_motor_xyz_m - simulated.mount_error_m).norm(), 0.002);
}

TEST(RigSolve, AWalkThatBeginsStandingTellsTheWholeMount) {
  const test::ScratchFolder folder;
  expect_mount_of_standing_part(walk_that_begins_standing(folder));
}

TEST(RigSolve, AWalkOfAOneWayMotorThatBeginsStandingTellsItToo) {
  const test::ScratchFolder folder;
  SimulationOptions simulated = walk_that_begins_standing(folder);
  simulated.motor = simulation::MotorKind::kOneWay;
  expect_mount_of_standing_part(simulated);
}

// A prior as narrow as what the walk shows takes half of it back, however often the walk is solved.
TEST(RigSolve, ANarrowPriorHoldsTheMountOfAWalk) {
  const Estimate found = solved(turned_walk(), {.mount = true, .mount_deg = 0.12});
  ASSERT_TRUE(found.rig && found.rig->mount.identifiable);
  EXPECT_LT(found.rig->found.turn_rad.norm() * kDegPerRad, 0.6 * 1.5);
  EXPECT_GT(found.rig->found.turn_rad.norm() * kDegPerRad, 0.1 * 1.5);
}

}  // namespace
}  // namespace sweepscope
