#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

class EstimateCommand : public test::ProgramTest {};

TEST_F(EstimateCommand, WritesTheJsonOfTheContract) {
  make({"simulate room-1 -o room.bag --offset-ms 7.3 --seed 5"});
  const Outcome outcome = run("estimate room.bag --method stationary --json -");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "sweepscope.estimate/1");
  EXPECT_EQ(json["recording"], "room.bag");
  EXPECT_EQ(json["method"], "stationary");
  EXPECT_EQ(json["equation"], "t_motor = t_laser + offset");
  EXPECT_EQ(json["identifiable"], true);
  EXPECT_NEAR(json["offset_ms"].get<double>(), 7.3, 0.5);
  EXPECT_EQ(json["criteria"]["d"]["offset_ms"], json["offset_ms"]);
  EXPECT_GT(json["sigma_ms"].get<double>(), 0);
  ASSERT_GT(json["curve"].size(), 20U);
  for (const char* key : {"offset_ms", "d", "translation_m", "rotation_rad", "signed_rotation_rad"})
    EXPECT_TRUE(json["curve"][0][key].is_number()) << key;
  EXPECT_TRUE(json["curve"][0]["n"].is_null());
  EXPECT_TRUE(json["curve"][0]["e_m"].is_null());
}

TEST_F(EstimateCommand, SaysTheAnswerInWholeLines) {
  make({"simulate room-1 -o room.bag"});
  const Outcome outcome = run("estimate room.bag");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find('\\'), std::string::npos) << "nothing of it is escaped: " << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 5) << outcome.out;
  EXPECT_NE(outcome.out.find("0.1 deg of gear play would add 0.128 ms"), std::string::npos) << outcome.out;
  EXPECT_TRUE(outcome.out.ends_with(" mm)\n")) << outcome.out;
}

TEST_F(EstimateCommand, AsksForCandidatesByThePapersMethods) {
  make({"simulate room-1 -o room.bag --offset-ms 7.3 --seed 5"});
  const Outcome outcome = run("estimate room.bag --range 5:9:1 --json -");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["method"], "stationary");
}

TEST_F(EstimateCommand, AnswersDirectlyWhereNothingElseIsAskedFor) {
  make({"simulate room-1 -o room.bag --offset-ms 7.3 --seed 5"});
  const Outcome outcome = run("estimate room.bag --json -");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["schema"], "sweepscope.estimate/1");
  EXPECT_EQ(json["recording"], "room.bag");
  EXPECT_EQ(json["method"], "direct");
  EXPECT_EQ(json["kind"], "stationary");
  EXPECT_EQ(json["equation"], "t_motor = t_laser + offset");
  EXPECT_EQ(json["identifiable"], true);
  EXPECT_NEAR(json["offset_ms"].get<double>(), 7.3, 0.06);
  EXPECT_GT(json["sigma_ms"].get<double>(), 0);
  EXPECT_EQ(json["criteria"]["direct"]["offset_ms"], json["offset_ms"]);
  ASSERT_GT(json["curve"].size(), 20U);
  for (const char* key : {"offset_ms", "capped_cost_m"})
    EXPECT_TRUE(json["curve"][0][key].is_number()) << key;
  for (const char* key : {"d", "n", "e_m"}) EXPECT_TRUE(json["curve"][0][key].is_null()) << key;
}

TEST_F(EstimateCommand, TheDirectAnswerIsTheSameBytesForAnyNumberOfThreads) {
  make({"simulate room-2 -o room.bag"});
  ASSERT_EQ(run("estimate room.bag --method direct --no-timing --threads 1 --json one.json").exit_code, 0);
  ASSERT_EQ(run("estimate room.bag --method direct --no-timing --threads 2 --json two.json").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "one.json"), test::contents_of(folder_ / "two.json"));
}

TEST_F(EstimateCommand, GivesTheSameBytesForAnyNumberOfThreads) {
  make({"simulate room-2 -o room.bag"});
  const std::string search = "estimate room.bag --range 20:28:0.5 --no-timing";
  ASSERT_EQ(run(search + " --threads 1 --json one.json --csv one.csv").exit_code, 0);
  ASSERT_EQ(run(search + " --threads 2 --json two.json --csv two.csv").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "one.json"), test::contents_of(folder_ / "two.json"));
  EXPECT_EQ(test::contents_of(folder_ / "one.csv"), test::contents_of(folder_ / "two.csv"));
}

TEST_F(EstimateCommand, SearchesAsThePaperDid) {
  make({"simulate room-3 -o room.bag"});
  const Outcome outcome =
      run("estimate room.bag --method stationary --range 19:29:1 --range 22:26:0.1 --json -");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["curve"].size(), 47U) << "11 + 41 candidates, of which 5 are the same";
  EXPECT_NEAR(json["offset_ms"].get<double>(), 24, 0.5);
  const Outcome around = run("estimate room.bag --method stationary --around 24:0.1:40 --json -");
  ASSERT_EQ(around.exit_code, 0) << around.err;
  EXPECT_EQ(Json::parse(around.out)["curve"].size(), 41U);
}

TEST_F(EstimateCommand, RefusesAStuckMotorAndStillWritesTheJson) {
  make({"simulate room-1 -o room.bag --motor stuck"});
  const Outcome outcome = run("estimate room.bag --json refused.json");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.out.find("does not move"), std::string::npos) << outcome.out;
  const Json json = Json::parse(test::contents_of(folder_ / "refused.json"));
  EXPECT_EQ(json["identifiable"], false);
  EXPECT_TRUE(json["offset_ms"].is_null());
  EXPECT_TRUE(json["sigma_ms"].is_null());
  EXPECT_FALSE(json["reasons"].empty());
}

TEST_F(EstimateCommand, RefusesAMotorThatTurnsOneWay) {
  make({"simulate room-1 -o room.bag --motor one-way"});
  const Outcome outcome = run("estimate room.bag");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.out.find("one way"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("--solve mount"), std::string::npos) << outcome.out;
}

TEST_F(EstimateCommand, SolvesForTheMountOfAMotorThatTurnsOneWay) {
  make({"simulate room-2 -o room.bag --motor one-way --duration-s 8 --mount-error-deg 0,2,1"});
  const Outcome outcome = run("estimate room.bag --solve mount --rig-out found.yaml --json found.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  const Json json = Json::parse(test::contents_of(folder_ / "found.json"));
  EXPECT_EQ(json["offset_is_gauge"], true);
  EXPECT_TRUE(json["offset_ms"].is_null());
  EXPECT_EQ(json["parameters"]["mount"]["identifiable"], true);
  EXPECT_EQ(run("map room.bag --rig found.yaml --offset-ms 0 -o room.ply").exit_code, 0);
}

TEST_F(EstimateCommand, RefusesAWalkThatIsSaidToStandStill) {
  make({"simulate metro-station -o walk.bag --duration-s 10"});
  const Outcome outcome = run("estimate walk.bag --method stationary");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.out.find("moved"), std::string::npos) << outcome.out;
}

TEST_F(EstimateCommand, RefusesAnExtremumOnTheEdgeOfTheRange) {
  make({"simulate room-1 -o room.bag"});
  const Outcome outcome = run("estimate room.bag --range 10:20:1");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.out.find("edge"), std::string::npos) << outcome.out;
}

TEST_F(EstimateCommand, FollowsAnOffsetOverTime) {
  make({"simulate room-2 -o room.bag --sweep-s 0.51 --duration-s 44 --clock-drift-ppm 200"});
  const Outcome refused = run("estimate room.bag");
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_NE(refused.out.find("--over-time"), std::string::npos) << refused.out;
  const Outcome found = run("estimate room.bag --over-time --json over.json --csv over.csv");
  ASSERT_EQ(found.exit_code, 0) << found.out << found.err;
  EXPECT_NE(found.out.find("\nrate "), std::string::npos) << found.out;
  const Json json = Json::parse(test::contents_of(folder_ / "over.json"));
  EXPECT_NEAR(json["offset_ms"].get<double>(), 24 + 0.2 * json["middle_s"].get<double>(), 0.1);
  EXPECT_NEAR(json["rate_ppm"].get<double>(), 200, 12);
  EXPECT_EQ(json["over_time"].size(), 4U);
  EXPECT_TRUE(json["jumps"].empty());
  const std::string table = test::contents_of(folder_ / "over.csv");
  EXPECT_EQ(table.rfind("t_s,offset_ms,sigma_ms,from_s,to_s,fit_ms\n", 0), 0U);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  EXPECT_EQ(run("estimate room.bag --over-time 20 --json -").exit_code, 0);
  EXPECT_EQ(run("estimate --over-time room.bag").exit_code, 0);
  for (const char* wrong : {"--over-time 0", "--over-time x", "--over-time --method stationary"})
    EXPECT_EQ(run(std::string("estimate room.bag ") + wrong).exit_code, 2) << wrong;
}

TEST_F(EstimateCommand, RefusesWrongUsage) {
  make({"simulate room-1 -o room.bag --duration-s 2"});
  EXPECT_EQ(run("estimate room.bag --range 29:19:1").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --range 19:29").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --around 24:0:4").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --method guess").exit_code, 2);
  EXPECT_EQ(run("estimate").exit_code, 2);
  // Before the recording is read: it is not there.
  for (const char* number : {"nan", "inf", "-inf"}) {
    for (const std::string& command :
         {"map no.bag -o map.pcd --offset-ms " + std::string(number),
          "map no.bag -o map.pcd --offset-ms 24 --voxel-m " + std::string(number),
          "compare no.bag -o out.png --offsets-ms 24," + std::string(number),
          "estimate no.bag --weight-c " + std::string(number),
          "estimate no.bag --edge-gate-m " + std::string(number)})
      EXPECT_EQ(run(command).exit_code, 2) << command;
  }
  const Outcome wide = run("estimate room.bag --range -300:300:1");
  EXPECT_EQ(wide.exit_code, 2);
  EXPECT_NE(wide.err.find("mirror image"), std::string::npos) << wide.err;
}

TEST_F(EstimateCommand, AFileThatIsNotThereIsExit3AndNothingIsWritten) {
  const Outcome outcome = run("estimate none.bag --json out.json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("none.bag"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("out.json"));
}

TEST_F(EstimateCommand, MapAndCompareWorkWithNoDisplay) {
  make({"simulate room-4 -o room.bag"});
  const Outcome map = run("map room.bag --offset-ms 24 -o map.pcd --trajectory map.tum");
  ASSERT_EQ(map.exit_code, 0) << map.err;
  EXPECT_TRUE(exists("map.pcd"));
  EXPECT_TRUE(exists("map.tum"));
  ASSERT_EQ(run("map room.bag --offset-ms 19 -o map.ply").exit_code, 0);
  const Outcome picture = run("compare room.bag --offsets-ms 19,24 -o out.png --size 960x600", "DISPLAY=:99");
  ASSERT_EQ(picture.exit_code, 0) << picture.err;
  EXPECT_GT(std::filesystem::file_size(folder_ / "out.png"), 10'000U);
  EXPECT_EQ(run("compare room.bag --offsets-ms 19 -o out2.png").exit_code, 2);
  EXPECT_EQ(run("map room.bag --offset-ms 24 -o map.xyz").exit_code, 2);
}

}  // namespace
}  // namespace sweepscope
