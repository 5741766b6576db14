#include "core/offset/readings/profile_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/offset/estimator.hpp"
#include "core/offset/readings/fitting_recording.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

// A motor without an encoder whose rig file says another speed than it had.
class ProfileSpeeds : public test::FolderTest {
 protected:
  ProfileSpeeds() {
    SimulationOptions options;
    options.scene = "room-2";
    options.duration_s = 7;
    options.sweep_s = 0.507;
    options.motor_messages = MotorMessages::kNone;
    const Simulation simulation = simulate(options, Job()).value();
    EXPECT_TRUE(write_bag(simulation, bag(), Job()));
    EXPECT_TRUE(write_truth(simulation, bag()));
    exact_.rig = read_rig(rig_path(bag())).value();
  }
  std::filesystem::path bag() const { return folder_ / "r.bag"; }
  double true_turns_per_s() const { return exact_.rig->motor.profile->turns_per_s; }
  Recording read(double stated_to_true, double within, const std::optional<TimeWindow>& part = {}) const {
    ReadOptions options = exact_;
    MotorProfile& profile = *options.rig->motor.profile;
    profile.turns_per_s *= stated_to_true;
    profile.turns_per_s_within = within;
    return read_fitting(bag(), options, Job(), part).value();
  }
  static bool says(const std::vector<std::string>& warnings, const std::string& words) {
    return std::ranges::any_of(
        warnings, [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
  }

  ReadOptions exact_;
};

TEST_F(ProfileSpeeds, AreFoundWithinWhatTheRigFileLeavesOpen) {
  const Estimate exact = estimate(read(1, 0), EstimateOptions(), Job()).value();
  ASSERT_TRUE(exact.identifiable);
  for (const double stated : {0.97, 1.003}) {
    const Recording recording = read(stated, 0.05);
    EXPECT_NEAR(recording.rig.motor.profile->turns_per_s / true_turns_per_s(), 1, 2e-5) << stated;
    EXPECT_TRUE(says(recording.report.warnings, "as the surfaces show")) << stated;
    const Estimate found = estimate(recording, EstimateOptions(), Job()).value();
    ASSERT_TRUE(found.identifiable) << stated;
    EXPECT_GT(*found.sigma_s, *exact.sigma_s) << stated;
    EXPECT_NEAR(*found.offset_s, *exact.offset_s, 3 * *found.sigma_s) << stated;
  }
}

// The profile counts from the first scan of the recording, not of the part.
TEST_F(ProfileSpeeds, LeaveMoreOfAnOffsetThatIsFoundLater) {
  const double first_s = read(1.003, 0.01, TimeWindow{0, 3}).report.profile_speed_sigma_s,
               last_s = read(1.003, 0.01, TimeWindow{4, 7}).report.profile_speed_sigma_s;
  EXPECT_GT(first_s, 0);
  EXPECT_NEAR(last_s / first_s, 5.5 / 1.5, 0.1);
}

TEST_F(ProfileSpeeds, OutsideOfThatAreNotTaken) {
  const Recording recording = read(1.15, 0.05);
  EXPECT_DOUBLE_EQ(recording.rig.motor.profile->turns_per_s, 1.15 * true_turns_per_s());
  EXPECT_TRUE(says(recording.report.warnings, "do not show how fast"));
  EXPECT_FALSE(estimate(recording, EstimateOptions(), Job()).value().identifiable);
}

TEST_F(ProfileSpeeds, ThatAreWrongAreNamedAsAReasonOfARefusal) {
  for (const double stated : {1.002, 1.01}) {
    const Estimate found = estimate(read(stated, 0), EstimateOptions(), Job()).value();
    EXPECT_FALSE(found.identifiable) << stated;
    EXPECT_TRUE(says(found.warnings, "turns_per_s_within")) << stated;
  }
}

TEST_F(ProfileSpeeds, AreWrittenIntoTheRig) {
  ReadOptions options = exact_;
  MotorProfile& profile = *options.rig->motor.profile;
  profile.turns_per_s *= 1.01;
  profile.turns_per_s_within = 0.015;
  const Rig rig = with_found(*options.rig, find_reading(bag(), options, Job()).value());
  EXPECT_NEAR(rig.motor.profile->turns_per_s / true_turns_per_s(), 1, 2e-5);
  EXPECT_EQ(rig.motor.profile->turns_per_s_within, 0);
}

}  // namespace
}  // namespace sweepscope
