#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/numbers.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

class MotorWithoutEncoder : public test::FolderTest {
 protected:
  /// A bag of a rig in a room, with the rig file that the simulator writes beside it.
  Simulation recorded(SimulationOptions options, MotorMessages messages) const {
    options.scene = "room-2";
    options.motor_messages = messages;
    Simulation simulation = simulate(options, Job()).value();
    EXPECT_TRUE(write_bag(simulation, bag(), Job()));
    EXPECT_TRUE(write_truth(simulation, bag()));
    return simulation;
  }
  std::filesystem::path bag() const { return folder_ / "r.bag"; }
  Result<Recording> read_with(const std::string& rig) const {
    std::ofstream(folder_ / "rig.yaml") << rig;
    auto read = read_rig(folder_ / "rig.yaml");
    if (!read) return tl::unexpected(read.error());
    ReadOptions options;
    options.rig = *read;
    return read_recording(bag(), options, Job());
  }
  Recording read_as_simulated() const {
    ReadOptions options;
    options.rig = read_rig(rig_path(bag())).value();
    return read_recording(bag(), options, Job()).value();
  }
};

SimulationOptions swinging() {
  SimulationOptions options;
  options.duration_s = 6;
  options.sweep_s = 0.613;
  options.motor = simulation::MotorKind::kTrapezoid;
  return options;
}

// The offset stands for the unknown start of the motion, the only thing that an encoder would have said.
TEST_F(MotorWithoutEncoder, TheOffsetIsTheUnknownStartOfTheProfile) {
  const Simulation truth = recorded(swinging(), MotorMessages::kNone);
  const Recording recording = read_as_simulated();
  ASSERT_TRUE(recording.rig.motor.profile);
  EXPECT_FALSE(recording.rig.motor.topic);
  const Estimate found = estimate(recording, EstimateOptions(), Job()).value();
  ASSERT_TRUE(found.identifiable) << (found.refusals.empty() ? "" : found.refusals[0].text);
  // With the found offset the angles are those of the true motor, or their mirror image.
  double same = 0, mirrored = 0;
  std::size_t count = 0;
  for (const LaserScan& scan : recording.scans) {
    const double middle_s = scan.first_beam_s;
    const double angle_rad = recording.motor.angle_at(middle_s + *found.offset_s),
                 true_rad = truth.recording.motor.angle_at(middle_s + truth.options.offset_s);
    same = std::max(same, std::abs(angle_rad - true_rad));
    mirrored = std::max(mirrored, std::abs(angle_rad + true_rad));
    ++count;
  }
  EXPECT_GT(count, 200u);
  EXPECT_LT(std::min(same, mirrored) * kDegPerRad, 0.5);
  EXPECT_NE(recording.report.warnings.front().find("not measured"), std::string::npos);
}

TEST_F(MotorWithoutEncoder, AnIndexPulseATurnIsTheMotorsAngle) {
  SimulationOptions options;
  options.motor = simulation::MotorKind::kOneWay;
  options.speeds_dps = {420, 300};
  options.duration_s = 12;
  const Simulation truth = recorded(options, MotorMessages::kIndex);
  const Recording recording = read_as_simulated();
  EXPECT_EQ(recording.rig.motor.topic, "/index");
  ASSERT_GT(recording.motor.time_s.size(), 1000u);
  // But for whole turns, and for the turn in which the speed changes.
  double largest_deg = 0;
  for (double t_s = 2; t_s < 4.6; t_s += 0.1) {
    const double apart_rad =
        recording.motor.angle_at(t_s + kMotorLatency_s) - truth.recording.motor.angle_at(t_s);
    largest_deg =
        std::max(largest_deg, std::abs(std::remainder(apart_rad, 2 * std::numbers::pi)) * kDegPerRad);
  }
  EXPECT_LT(largest_deg, 0.2);  // the encoder that the marks are made from: its steps and jitter
  EXPECT_TRUE(estimate(recording, EstimateOptions(), Job()).value().kind);
}

TEST_F(MotorWithoutEncoder, ProfilesThatMakeNoSenseAreRefusedWithTheirPlace) {
  recorded(swinging(), MotorMessages::kNone);
  for (const auto& [rig, why] : {
           std::pair("motor: {profile: {between_deg: [0, 90]}}", "needs turns_per_s"),
           std::pair("motor: {profile: {turns_per_s: 0}}", "not be 0"),
           std::pair("motor: {profile: {turns_per_s: 0.5, between_deg: [10, 10.5]}}", "1 deg apart"),
           std::pair("motor: {profile: {turns_per_s: -0.5, between_deg: [0, 90]}}", "not negative"),
           std::pair("motor: {profile: {turns_per_s: 0.5, between_deg: [0, 90], ramp_s: 1}}", "at most half"),
           std::pair("motor: {profile: {turns_per_s: 0.5, turns_per_s_within: 0.01}}", "needs between_deg"),
           std::pair("motor: {profile: {turns_per_s: 0.5, between_deg: [0, 90], turns_per_s_within: 0.2}}",
                     "a fifth"),
           std::pair("motor: {profile: {turns_per_s: 0.5, dwell_s: 0.1}}", "needs steps_per_turn"),
           std::pair("motor: {profile: {turns_per_s: 0.5, steps_per_turn: 100, dwell_s: 0.1}}",
                     "longer than a step"),
           std::pair("motor: {profile: {turns_per_s: 0.5, start_s: soon}}", "start_s"),
           std::pair("motor: {topic: /a, profile: {turns_per_s: 0.5}}", "leave out topic"),
           std::pair("motor: {index: {field: data}}", "needs topic"),
       }) {
    const auto read = read_with(rig);
    ASSERT_FALSE(read) << rig;
    EXPECT_EQ(read.error().code, ExitCode::kUnreadableInput) << rig;
    EXPECT_NE(read.error().message.find(why), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("rig.yaml:1:"), std::string::npos) << read.error().message;
  }
}

TEST_F(MotorWithoutEncoder, ScansInRestsAndStepsAreToldApart) {
  recorded(swinging(), MotorMessages::kNone);
  const Recording recording =
      read_with("motor: {profile: {turns_per_s: 0.1, steps_per_turn: 20, dwell_s: 0.4, start_s: 0}}").value();
  // 25 ms of a scan lie within a rest for 375 of 500 ms.
  const std::string& said = recording.report.warnings.front();
  const auto at = said.find(" of 240 scans lie within a rest");
  ASSERT_NE(at, std::string::npos) << said;
  const double resting = std::stod(said.substr(said.rfind(' ', at - 1)));
  EXPECT_NEAR(resting / 240, 0.765, 0.05);
}

}  // namespace
}  // namespace sweepscope
