// One answer from several recordings of one rig: `estimate --together`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

class TogetherCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    std::vector<std::string> commands;
    for (const char* room : {"1", "2"})
      commands.push_back(std::string("simulate room-") + room + " -o " + room +
                         ".bag --duration-s 5 --sweep-s 0.513 --mount-error-deg 0,1,-0.5");
    make(commands);
  }
};

TEST_F(TogetherCommand, PrintsWhatEachContributesAndWritesTheRigOfAll) {
  const Outcome outcome =
      run("estimate 1.bag 2.bag --together --solve offset,mount --rig-out rig.yaml --json t.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part :
       {"offset   2", "1.bag: ", "% of the offset", "mm thick before", "agreement  chi-square"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
  const Json document = Json::parse(test::contents_of(folder_ / "t.json"));
  EXPECT_EQ(document["recording"], "1.bag, 2.bag");
  EXPECT_EQ(document["offsets"], "one");
  EXPECT_EQ(document["degrees_of_freedom"], 5);
  ASSERT_EQ(document["recordings"].size(), 2u);
  for (const Json& one : document["recordings"]) {
    EXPECT_NEAR(one["offset_ms"].get<double>(), 24, 0.1);
    EXPECT_GT(one["shift_sigma_m"].get<double>(), 0);
    EXPECT_TRUE(one["reasons"].empty());
  }
  EXPECT_NEAR(document["parameters"]["mount"]["rpy_deg"][1].get<double>(), 1, 0.05);
  // The rig file flattens both.
  const Outcome with_rig = run("estimate 1.bag 2.bag --together --rig rig.yaml --json -");
  ASSERT_EQ(with_rig.exit_code, 0);
  EXPECT_EQ(with_rig.err.find("another mount"), std::string::npos) << with_rig.err;
}

TEST_F(TogetherCommand, OneOffsetForEachHasNoCommonOne) {
  const Outcome outcome = run("estimate 1.bag 2.bag --together --offsets each --json -");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out);
  EXPECT_TRUE(document["identifiable"].get<bool>());
  EXPECT_TRUE(document["offset_ms"].is_null());
  EXPECT_EQ(document["offsets"], "each");
  EXPECT_NEAR(document["recordings"][1]["offset_ms"].get<double>(), 24, 0.1);
}

TEST_F(TogetherCommand, WhatMakesNoSenseTogetherIsRefusedBeforeAnyWork) {
  for (const char* arguments :
       {"1.bag --together", "1.bag 2.bag --together --resume f", "1.bag 2.bag --together --table t.csv",
        "1.bag 2.bag --together --csv t.csv", "1.bag 2.bag --together --window 0:3",
        "1.bag 2.bag --together --offsets each --expect 24+-1", "1.bag 2.bag --offsets each",
        "1.bag 2.bag --together --range 19:29:1"}) {
    const Outcome outcome = run(std::string("estimate ") + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
  }
  const Outcome missing = run("estimate 1.bag none.bag --together --json t.json");
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_FALSE(exists("t.json"));
}

}  // namespace
}  // namespace sweepscope
