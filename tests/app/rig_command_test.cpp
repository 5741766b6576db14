#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class RigCommand : public test::ProgramTest {};

TEST_F(RigCommand, WritesARigThatEstimateReadsAsItReadsTheRecordingWithoutOne) {
  ASSERT_EQ(run("simulate room-1 --duration-s 2 -o room.bag").exit_code, 0);
  const Outcome said = run("rig room.bag");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("topic: /scan"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("80 scans of 721 beams, 40.00 Hz, frame laser"), std::string::npos) << said.out;
  EXPECT_EQ(run("rig room.bag -o rig.yaml").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "rig.yaml"), said.out);
  const std::string estimate = "estimate room.bag --method stationary --range 23:25:1 --no-timing --json - ";
  const Outcome without = run(estimate), with = run(estimate + "--rig rig.yaml");
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(with.out, without.out);
}

TEST_F(RigCommand, WhatEstimateSolvesForIsWrittenAndReadBack) {
  ASSERT_EQ(run("simulate room-2 --duration-s 4 --mount-error-deg 0,3,-4 --eccentricity-deg 0.3 -o room.bag")
                .exit_code,
            0);
  const Outcome solved =
      run("estimate room.bag --solve offset,mount,encoder --rig-out rig.yaml --no-timing --json solved.json");
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  const auto document = nlohmann::json::parse(test::contents_of(folder_ / "solved.json"));
  const auto& parameters = document.at("parameters");
  EXPECT_TRUE(parameters.at("mount").at("identifiable").get<bool>());
  EXPECT_NEAR(parameters.at("mount").at("rpy_deg")[1].get<double>(), 3, 0.2);
  EXPECT_NEAR(parameters.at("mount").at("rpy_deg")[2].get<double>(), -4, 0.2);
  EXPECT_EQ(parameters.at("correlation").at("of").size(), 7u);
  EXPECT_LT(parameters.at("residual_after_m").get<double>(),
            parameters.at("residual_before_m").get<double>());
  EXPECT_FALSE(parameters.contains("play"));

  const Outcome with = run("estimate room.bag --rig rig.yaml --no-timing --json -");
  ASSERT_EQ(with.exit_code, 0) << with.err;
  EXPECT_NEAR(nlohmann::json::parse(with.out).at("offset_ms").get<double>(),
              document.at("offset_ms").get<double>(), 0.002);
  const Outcome again = run("rig room.bag --rig rig.yaml");
  EXPECT_NE(again.out.find("encoder: {amplitude_deg: "), std::string::npos) << again.out;
}

TEST_F(RigCommand, SolveTakesTheNamesOfPartsAndPriorsAboveZero) {
  ASSERT_EQ(run("simulate room-1 --duration-s 1 -o room.bag").exit_code, 0);
  EXPECT_EQ(run("estimate room.bag --solve offset,axis").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --solve mount --prior mount_deg=0").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --solve mount --prior tilt_deg=1").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --solve mount --range 20:28:1").exit_code, 2);
  const Outcome alone = run("estimate room.bag --rig-out rig.yaml");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("--solve"), std::string::npos) << alone.err;
  EXPECT_EQ(run("estimate room.bag --solve mount --rig-out room.bag").exit_code, 2);
}

TEST_F(RigCommand, WhatItCannotReadOrWriteIsSaid) {
  EXPECT_EQ(run("rig missing.bag").exit_code, 3);
  ASSERT_EQ(run("simulate room-1 --duration-s 1 -o room.bag").exit_code, 0);
  EXPECT_EQ(run("rig room.bag -o no/such/rig.yaml").exit_code, 2);
}

}  // namespace
}  // namespace sweepscope
