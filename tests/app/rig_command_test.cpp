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

TEST_F(RigCommand, WhatItCannotReadOrWriteIsSaid) {
  EXPECT_EQ(run("rig missing.bag").exit_code, 3);
  ASSERT_EQ(run("simulate room-1 --duration-s 1 -o room.bag").exit_code, 0);
  EXPECT_EQ(run("rig room.bag -o no/such/rig.yaml").exit_code, 2);
}

}  // namespace
}  // namespace sweepscope
