#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class RigCommand : public test::ProgramTest {};

TEST_F(RigCommand, WritesARigThatEstimateReadsAsItReadsTheRecordingWithoutOne) {
  make({"simulate room-1 --duration-s 2 -o room.bag"});
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
  make({"simulate room-2 --duration-s 4 --mount-error-deg 0,3,-4 --eccentricity-deg 0.3 -o room.bag"});
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
  EXPECT_NE(again.out.find("; from the given rig file"), std::string::npos) << again.out;
  EXPECT_NE(test::contents_of(folder_ / "rig.yaml").find("mount:  # found by estimate --solve: +- "),
            std::string::npos);

  const Outcome of_estimate = run("rig room.bag --estimate solved.json -o of-estimate.yaml");
  ASSERT_EQ(of_estimate.exit_code, 0) << of_estimate.err;
  const std::string text = test::contents_of(folder_ / "of-estimate.yaml");
  EXPECT_NE(text.find("mount:  # found by estimate --solve in solved.json: +- "), std::string::npos) << text;
  EXPECT_EQ(run("estimate room.bag --rig of-estimate.yaml --no-timing --json -").out, with.out);
  const std::string urdf = " --as urdf --estimate solved.json";
  EXPECT_EQ(run("rig room.bag" + urdf).out, run("rig room.bag --rig rig.yaml" + urdf).out);
}

TEST_F(RigCommand, WhatTheRecordingDoesNotDetermineIsNamedInTheRigFile) {
  make({"simulate room-1 --duration-s 4 -o room.bag"});
  ASSERT_EQ(run("estimate room.bag --solve offset,play --json E.json --rig-out rig.yaml").exit_code, 0);
  const Outcome said = run("rig room.bag --estimate E.json");
  for (const std::string& text : {said.out, test::contents_of(folder_ / "rig.yaml")}) {
    EXPECT_NE(text.find("# play_deg: 0"), std::string::npos) << text;
    EXPECT_NE(text.find("unchanged: The motor turns at one speed only"), std::string::npos) << text;
  }
}

TEST_F(RigCommand, AnEstimateThatSolvedForNothingHasNoRig) {
  make({"simulate room-1 --duration-s 3 -o room.bag"});
  ASSERT_EQ(run("estimate room.bag --json E.json").exit_code, 0);
  const Outcome said = run("rig room.bag --estimate E.json");
  EXPECT_EQ(said.exit_code, 2);
  EXPECT_NE(said.err.find("--solve"), std::string::npos) << said.err;
}

TEST_F(RigCommand, SolveTakesTheNamesOfPartsAndPriorsAboveZero) {
  make({"simulate room-1 --duration-s 1 -o room.bag"});
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
  make({"simulate room-1 --duration-s 1 -o room.bag"});
  EXPECT_EQ(run("rig room.bag -o no/such/rig.yaml").exit_code, 2);
}

TEST_F(RigCommand, AsWritesTheMountAndTheOffsetOfARecordingOrARigFile) {
  make({"simulate room-1 --duration-s 3 --offset-ms 24 -o room.bag"});
  ASSERT_EQ(run("rig room.bag -o rig.yaml").exit_code, 0);
  ASSERT_EQ(run("estimate room.bag --no-timing --json E.json").exit_code, 0);
  const double offset_ms =
      nlohmann::json::parse(test::contents_of(folder_ / "E.json")).at("offset_ms").get<double>();
  for (const char* system :
       {"urdf", "xacro", "ros2-static-tf", "laser_assembler", "cartographer", "fast-lio", "driver-params"}) {
    const std::string as = std::string(" --as ") + system;
    const Outcome of_estimate = run("rig room.bag --estimate E.json" + as);
    ASSERT_EQ(of_estimate.exit_code, 0) << of_estimate.err;
    EXPECT_NE(of_estimate.out.find(fmt::format("offset {:.9f} s", offset_ms * 1e-3)), std::string::npos)
        << of_estimate.out;
    EXPECT_EQ(run("rig room.bag --offset-ms " + fmt::format("{}", offset_ms) + as).out, of_estimate.out);
    EXPECT_EQ(run("rig rig.yaml -o out --estimate E.json" + as).exit_code, 0);
    std::string of_rig = test::contents_of(folder_ / "out");
    of_rig.replace(of_rig.find("rig.yaml"), 8, "room.bag");
    EXPECT_EQ(of_rig, of_estimate.out);
  }
}

TEST_F(RigCommand, AsNeedsASystemAndOneOffset) {
  make({"simulate room-1 --duration-s 1 -o room.bag"});
  ASSERT_EQ(run("rig room.bag -o rig.yaml").exit_code, 0);
  for (const char* arguments :
       {"room.bag --as urdf", "room.bag --as sdf --offset-ms 24", "room.bag --offset-ms 24",
        "rig.yaml --as urdf --offset-ms 24 -o rig.yaml", "rig.yaml --rig rig.yaml --as urdf --offset-ms 24",
        "room.bag --as urdf --offset-ms nan"})
    EXPECT_EQ(run(std::string("rig ") + arguments).exit_code, 2) << arguments;
  EXPECT_EQ(run("rig rig.yaml").exit_code, 3) << "no recording";
  EXPECT_EQ(run("rig missing.yaml --as urdf --offset-ms 24").exit_code, 3);
  EXPECT_EQ(run("rig room.bag --as urdf --estimate missing.json").exit_code, 3);
}

}  // namespace
}  // namespace sweepscope
