#include "core/together/estimate_together.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>

#include "core/results/estimate_json.hpp"
#include "core/rig_solve/rig_solve.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kCommonOffset_s = 0.017;
const Eigen::Vector3d kTurn_deg(0, 1.2, -0.9), kShift_m(0, 0.02, -0.03);

SimulationOptions rig_in(const std::string& scene, double offset_s = kCommonOffset_s) {
  SimulationOptions options;
  options.scene = scene;
  options.offset_s = offset_s;
  options.duration_s = 5;
  options.sweep_s = 0.513;
  options.mount_error_deg = kTurn_deg;
  options.mount_error_m = kShift_m;
  return options;
}

Recording made(const SimulationOptions& options, const std::string& name) {
  Recording recording = simulate(options, Job()).value().recording;
  recording.name = name;
  return recording;
}

// Three rooms; the recordings are made once per program.
const std::vector<Recording>& rooms() {
  static const std::vector<Recording> recordings{
      made(rig_in("room-1"), "a.bag"), made(rig_in("room-2"), "b.bag"), made(rig_in("room-4"), "c.bag")};
  return recordings;
}

EstimateOptions solving(bool mount) {
  EstimateOptions options;
  options.solve.mount = mount;
  return options;
}

Result<Estimate> together(const std::vector<Recording>& recordings, const EstimateOptions& options,
                          bool own_offsets = false) {
  return estimate_together({recordings.begin(), recordings.end()}, options, own_offsets, Job());
}

double sigma_of_shift_m(const Estimate& found) {
  return std::sqrt(found.rig->covariance.block<2, 2>(kShiftU, kShiftU).trace());
}

void expect_mount(const Estimate& found) {
  ASSERT_TRUE(found.rig);
  ASSERT_TRUE(found.rig->mount.identifiable) << found.rig->mount.reason;
  EXPECT_LT((found.rig->rig.mount.laser_in_motor_rpy_deg - kTurn_deg).norm(), 0.04);
  EXPECT_LT((found.rig->rig.mount.laser_in_motor_xyz_m - kShift_m).norm(), 3 * sigma_of_shift_m(found));
}

TEST(EstimateTogether, DeterminesTheMountBetterThanEachRecordingAlone) {
  const Estimate found = together(rooms(), solving(true)).value();
  ASSERT_TRUE(found.identifiable);
  expect_mount(found);
  EXPECT_LT(std::abs(*found.offset_s - kCommonOffset_s), 3 * *found.sigma_s);
  for (std::size_t i = 0; i < rooms().size(); ++i) {
    const Estimate alone = estimate(rooms()[i], solving(true), Job()).value();
    EXPECT_LT(sigma_of_shift_m(found), 0.9 * sigma_of_shift_m(alone)) << rooms()[i].name;
    const RecordingOfRig& evidence = found.together->recordings[i];
    EXPECT_EQ(evidence.recording, rooms()[i].name);
    EXPECT_LT(*evidence.residual_after_m, 0.5 * *evidence.residual_before_m) << rooms()[i].name;
    EXPECT_GT(evidence.share, 0.1);
  }
  EXPECT_EQ(found.together->degrees_of_freedom, 10);  // offset, turn and shift, twice
  EXPECT_LT(found.together->chi_square, 20);
  EXPECT_EQ(found.recording, "a.bag, b.bag, c.bag");
}

TEST(EstimateTogether, WithAnOffsetEachTheRecordingsShareOneMount) {
  const std::vector<Recording> recordings{made(rig_in("room-1", 0.017), "a.bag"),
                                          made(rig_in("room-2", -0.030), "b.bag"),
                                          made(rig_in("room-4", 0.024), "c.bag")};
  const Estimate found = together(recordings, solving(true), true).value();
  ASSERT_TRUE(found.identifiable);
  EXPECT_FALSE(found.offset_s);
  expect_mount(found);
  const std::vector<double> truth_s{0.017, -0.030, 0.024};
  for (std::size_t i = 0; i < truth_s.size(); ++i) {
    const RecordingOfRig& one = found.together->recordings[i];
    ASSERT_TRUE(one.offset_s);
    EXPECT_LT(std::abs(*one.offset_s - truth_s[i]), 3 * *one.sigma_s);
    EXPECT_LT(*one.sigma_s, 0.1 * kMs);
    // It contains the uncertainty of the rig.
    const Estimate with_given_rig =
        estimate(with_rig(recordings[i], *found.rig), EstimateOptions(), Job()).value();
    EXPECT_GT(found.rig->own_offset_sigma_s[i], 0);
    EXPECT_NEAR(*one.sigma_s, std::hypot(*with_given_rig.sigma_s, found.rig->own_offset_sigma_s[i]), 1e-12);
    EXPECT_NEAR(found.rig->found.of_recording(i).offset_s, truth_s[i], 0.1 * kMs);
  }
  EXPECT_EQ(found.together->degrees_of_freedom, 8);  // turn and shift, twice
}

TEST(EstimateTogether, NamesARecordingOfAnotherRig) {
  SimulationOptions other = rig_in("room-2");
  other.mount_error_deg = {0, 0.4, -0.9};
  const std::vector<Recording> recordings{rooms()[0], made(other, "other.bag"), rooms()[2]};
  const Estimate found = together(recordings, solving(true)).value();
  EXPECT_FALSE(found.identifiable);
  EXPECT_FALSE(found.offset_s);
  ASSERT_EQ(found.refusals.size(), 1u);
  EXPECT_EQ(found.refusals[0].kind, RefusalKind::kRecordingsDiffer);
  EXPECT_NE(found.refusals[0].text.find("other.bag differs from the others by 0.79 deg"), std::string::npos)
      << found.refusals[0].text;
}

TEST(EstimateTogether, NamesARecordingWithAnotherOffset) {
  const std::vector<Recording> recordings{rooms()[0], made(rig_in("room-2", 0.0182), "other.bag"),
                                          rooms()[2]};
  const Estimate found = together(recordings, solving(false)).value();
  EXPECT_FALSE(found.identifiable);
  ASSERT_EQ(found.refusals.size(), 1u);
  EXPECT_EQ(found.refusals[0].kind, RefusalKind::kRecordingsDiffer);
  EXPECT_NE(found.refusals[0].text.find("other.bag differs from the others by 1.19"), std::string::npos)
      << found.refusals[0].text;
  EXPECT_NE(found.refusals[0].text.find("--offsets each"), std::string::npos);
  const Estimate each = together(recordings, solving(false), true).value();
  EXPECT_TRUE(each.identifiable);
  EXPECT_NEAR(*each.together->recordings[1].offset_s, 0.0182, 0.1 * kMs);
}

TEST(EstimateTogether, ARecordingThatIsRefusedIsLeftOutWithItsReason) {
  SimulationOptions stuck = rig_in("room-2");
  stuck.motor = simulation::MotorKind::kStuck;
  const std::vector<Recording> recordings{rooms()[0], made(stuck, "stuck.bag")};
  const Estimate found = together(recordings, solving(false)).value();
  ASSERT_TRUE(found.identifiable);
  const RecordingOfRig& left_out = found.together->recordings[1];
  EXPECT_FALSE(left_out.offset_s);
  EXPECT_EQ(left_out.share, 0);
  ASSERT_FALSE(left_out.reasons.empty());
  EXPECT_NE(left_out.reasons[0].find("The motor does not move"), std::string::npos);
  const Estimate none = together({recordings[1], recordings[1]}, solving(false)).value();
  EXPECT_FALSE(none.identifiable);
  EXPECT_EQ(none.refusals[0].text.rfind("stuck.bag: The motor does not move", 0), 0u);
}

TEST(EstimateTogether, SpinningRigsShareAMountAndHaveNoOffset) {
  std::vector<Recording> recordings;
  for (const char* scene : {"room-1", "room-2"}) {
    SimulationOptions options = rig_in(scene);
    options.motor = simulation::MotorKind::kOneWay;
    options.speeds_dps = {350};
    recordings.push_back(made(options, scene));
  }
  const Estimate found = together(recordings, solving(true)).value();
  EXPECT_FALSE(found.identifiable);
  EXPECT_TRUE(found.offset_is_gauge());
  expect_mount(found);
}

TEST(EstimateTogether, RigFilesThatDifferAndSingleRecordingsAreWrongUsage) {
  std::vector<Recording> recordings = rooms();
  recordings[1].rig.mount.laser_in_motor_xyz_m.x() = 0.1;
  const auto differ = together(recordings, solving(true));
  ASSERT_FALSE(differ);
  EXPECT_EQ(differ.error().code, ExitCode::kWrongUsage);
  EXPECT_NE(differ.error().message.find("a.bag and b.bag have different mounts"), std::string::npos);
  const auto single = together({rooms()[0]}, solving(false));
  ASSERT_FALSE(single);
  EXPECT_EQ(single.error().code, ExitCode::kWrongUsage);
  EstimateOptions paper;
  paper.method = Method::kStationary;
  EXPECT_EQ(together(rooms(), paper).error().code, ExitCode::kWrongUsage);
}

TEST(EstimateTogether, AnswersAreTheSameBytesForAnyNumberOfThreads) {
  const auto answer = [] {
    return estimate_to_json(together({rooms()[0], rooms()[1]}, solving(true)).value(), Timing::kNull);
  };
  const std::string with_all = answer();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(answer(), with_all);
}

}  // namespace
}  // namespace sweepscope
