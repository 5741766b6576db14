#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class ApplyCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    make({"simulate room-1 -o room.bag", "estimate room.bag --no-timing --json room.json"});
  }
  nlohmann::json estimate(const std::string& recording) const {
    const Outcome outcome = run("estimate " + recording + " --no-timing --json -");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(ApplyCommand, TheRecordingHasNoOffsetAfterwardsInAnyFormat) {
  ASSERT_EQ(run("convert room.bag -o room.mcap").exit_code, 0);
  for (const char* arguments : {"room.bag -o out.bag", "room.bag -o out1.mcap", "room.mcap -o out2.mcap",
                                "room.mcap -o out.db3", "room.bag -o laser.bag --shift laser"}) {
    const Outcome outcome = run(std::string("apply --estimate room.json ") + arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string output = outcome.out.substr(0, outcome.out.find(':'));
    const nlohmann::json found = estimate(output);
    EXPECT_LT(std::abs(found["offset_ms"].get<double>()), 0.01) << output;
  }
  ASSERT_EQ(run("apply out.db3 -o folder --offset-ms 0 --again").exit_code, 0);
  EXPECT_TRUE(exists("folder/metadata.yaml"));
  EXPECT_LT(std::abs(estimate("folder")["offset_ms"].get<double>()), 0.01);
}

TEST_F(ApplyCommand, SweepsAsFilesWithTheirPoses) {
  const Outcome outcome = run("apply room.bag --estimate room.json --clouds-only sweeps");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "sweeps: 10 sweeps of a stationary rig, and poses.tum\n");
  EXPECT_TRUE(exists("sweeps/000000.pcd"));
  EXPECT_TRUE(exists("sweeps/000009.pcd"));
  EXPECT_TRUE(exists("sweeps/poses.tum"));
  EXPECT_FALSE(exists("sweeps/000010.pcd"));
  ASSERT_EQ(run("convert room.bag -o tables").exit_code, 0);
  EXPECT_EQ(run("apply tables --offset-ms 24 --clouds-only of-tables --clouds-format ply").exit_code, 0);
  EXPECT_TRUE(exists("of-tables/000009.ply"));
  EXPECT_EQ(run("apply room.bag --offset-ms 24 --clouds-only sweeps").exit_code, 2);
}

TEST_F(ApplyCommand, SweepsOfARecordingThatIsRightAlreadyAreNotShiftedAgain) {
  ASSERT_EQ(run("convert room.bag -o room.mcap").exit_code, 0);
  for (const std::string format : {".bag", ".mcap"}) {
    const std::string out = "out" + format;
    ASSERT_EQ(run("apply room" + format + " --estimate room.json -o " + out).exit_code, 0);
    const Outcome twice = run("apply " + out + " --estimate room.json --clouds-only twice");
    EXPECT_EQ(twice.exit_code, 2);
    EXPECT_NE(twice.err.find("an offset was applied before"), std::string::npos) << twice.err;
    EXPECT_FALSE(exists("twice"));
    EXPECT_EQ(run("apply " + out + " --offset-ms 0 --again --clouds-only of-" + out).exit_code, 0);
  }
}

TEST_F(ApplyCommand, TheRecordingWithCloudsHasTheSameOffset) {
  ASSERT_EQ(run("apply room.bag --estimate room.json -o out.bag --clouds /sweeps --tf").exit_code, 0);
  EXPECT_LT(std::abs(estimate("out.bag")["offset_ms"].get<double>()), 0.01);
}

TEST_F(ApplyCommand, WrongUsageSaysWhatIsWrongAndWritesNothing) {
  const auto refused = [&](const std::string& arguments, int exit_code = 2) {
    const Outcome outcome = run("apply " + arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << arguments;
    return outcome.err;
  };
  EXPECT_NE(refused("room.bag -o out.bag").find("one of --estimate and --offset-ms"), std::string::npos);
  EXPECT_NE(refused("room.bag -o out.bag --offset-ms 24 --estimate room.json").find("one of --estimate"),
            std::string::npos);
  EXPECT_NE(refused("room.bag --offset-ms 24").find("-o OUT, or --clouds-only DIR"), std::string::npos);
  EXPECT_NE(refused("room.bag --offset-ms 24 --clouds-only dir --tf").find("name it with -o OUT"),
            std::string::npos);
  EXPECT_NE(refused("room.bag -o out.bag --offset-ms 24 --poses p.tum").find("--poses is used by"),
            std::string::npos);
  EXPECT_NE(refused("room.bag -o room.bag --offset-ms 24").find("is an input of this command"),
            std::string::npos);
  EXPECT_NE(refused("room.bag -o no/such/out.bag --offset-ms 24").find("cannot be created"),
            std::string::npos);
  EXPECT_NE(refused("room.bag -o out.xyz --offset-ms 24").find("has no known extension"), std::string::npos);
  refused("missing.bag -o out.bag --offset-ms 24", 3);
  ASSERT_EQ(run("convert room.bag -o tables").exit_code, 0);
  EXPECT_NE(refused("tables -o out.bag --offset-ms 24").find("is a folder of CSV tables"), std::string::npos);
  EXPECT_FALSE(exists("out.bag"));
}

}  // namespace
}  // namespace sweepscope
