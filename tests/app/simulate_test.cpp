#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

class SimulateCommand : public test::ProgramTest {
 protected:
  Outcome simulate(const std::string& arguments) const { return run("simulate " + arguments); }
};

TEST_F(SimulateCommand, WritesTheBagAndItsTruth) {
  const Outcome outcome =
      simulate("metro-station -o walk.bag --duration-s 1.5 --offset-ms -7.5 --sweep-s 0.513");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("t_motor = t_laser - 7.5 ms"), std::string::npos) << outcome.err;
  EXPECT_GT(fs::file_size(folder_ / "walk.bag"), 100'000U);
  EXPECT_TRUE(fs::exists(folder_ / "walk.truth.tum"));
  const auto truth = nlohmann::json::parse(std::ifstream(folder_ / "walk.truth.json"));
  EXPECT_EQ(truth["offset_ms"], -7.5);
  EXPECT_EQ(truth["options"]["sweep_s"], 0.513);
}

TEST_F(SimulateCommand, RefusesWrongUsageAndWritesNothing) {
  for (const char* arguments :
       {"hall -o a.bag", "room-1 -o a.bag --noise-mm -1", "room-1 -o a.bag --motor square",
        "room-1 -o a.bag --duration-s nan", "room-1", "room-1 -o a.bag --dropout 1.5"})
    EXPECT_EQ(simulate(arguments).exit_code, 2) << arguments;
  EXPECT_EQ(test::files_in(folder_).size(), 2U) << "what it said";
}

TEST_F(SimulateCommand, WritesAsTheDriverOfAScannerDoesAndARigFileToReadIt) {
  const Outcome outcome = simulate("room-1 -o a.bag --scanner rplidar-a1 --axis -y --duration-s 1");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("a.rig.yaml says how it is to be read"), std::string::npos) << outcome.out;
  EXPECT_NE(test::contents_of(folder_ / "a.rig.yaml").find("axis: [0, -1, 0]"), std::string::npos);
  const auto truth = nlohmann::json::parse(std::ifstream(folder_ / "a.truth.json"));
  EXPECT_EQ(truth["recorded_as"]["beam_times"], "reversed");
  EXPECT_EQ(simulate("room-1 -o b.bag --duration-s 1").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "b.rig.yaml"));
  EXPECT_FALSE(nlohmann::json::parse(std::ifstream(folder_ / "b.truth.json")).contains("recorded_as"));
}

TEST_F(SimulateCommand, ATiltedRigIsReadWithTheRigFileThatSimulateWrites) {
  EXPECT_EQ(simulate("room-2 -o a.bag --axis y --swing-deg 45 --laser-upside-down").exit_code, 0);
  const Outcome outcome = run("estimate a.bag --rig a.rig.yaml --expect 24+-0.3");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

TEST_F(SimulateCommand, NamesTheChoicesWhereAnOptionIsNotOneOfThem) {
  for (const auto& [arguments, choices] :
       {std::pair("--scanner lms200", "--scanner needs one of utm30lx-180, utm30lx"),
        std::pair("--axis w", "--axis needs one of x, y, z, -x, -y, -z, not 'w'"),
        std::pair("--beam-times back", "--beam-times needs one of spread, instant, reversed"),
        std::pair("--stamp-at arrival", "--stamp-at needs one of first_beam, last_beam")}) {
    const Outcome outcome = simulate(std::string("room-1 -o a.bag ") + arguments);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_NE(outcome.err.find(choices), std::string::npos) << outcome.err;
  }
}

TEST_F(SimulateCommand, MakesAWorldAndAWalkAtRandom) {
  const Outcome outcome =
      simulate("--world corridor:7 --walk calm:3 -o a.bag --duration-s 5 --scanner lms111");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("corridor:7 calm:3 for 5 s"), std::string::npos) << outcome.out;
  const auto truth = nlohmann::json::parse(std::ifstream(folder_ / "a.truth.json"));
  EXPECT_EQ(truth["random_world"]["world_seed"], 7);
  EXPECT_EQ(truth["random_world"]["walk"], "calm");
}

TEST_F(SimulateCommand, TakesTheSeedOfAWorldFromItsOwnSeed) {
  EXPECT_EQ(simulate("--world hall -o a.bag --duration-s 5 --seed 9").exit_code, 0);
  EXPECT_EQ(simulate("--world hall:9 --walk brisk:9 -o b.bag --duration-s 5 --seed 9").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "a.bag"), test::contents_of(folder_ / "b.bag"));
}

TEST_F(SimulateCommand, RefusesAWorldThatIsUnknownOrNotAlone) {
  for (const auto& [arguments, reason] :
       {std::pair("--world castle",
                  "the worlds are yard, forest, street, corridor, hall, tunnel, stairs, car-park"),
        std::pair("--world yard --walk slow", "the walks are calm, brisk, wild, stand"),
        std::pair("--world yard:x", "--world needs NAME or NAME:SEED"),
        std::pair("--world yard --duration-s 601", "last 5 to 600 s"),
        std::pair("--world yard room-1", "excludes"), std::pair("room-1 --walk calm", "--world")}) {
    const Outcome outcome = simulate(std::string("-o a.bag ") + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
  }
}

TEST_F(SimulateCommand, NamesTheScenesWhereOneIsUnknown) {
  EXPECT_NE(simulate("hall -o a.bag").err.find("the scenes are metro-station, parking-area, cemetery"),
            std::string::npos);
}

TEST_F(SimulateCommand, CannotWriteIntoAFolderThatIsNotThere) {
  const Outcome outcome = simulate("room-1 -o nowhere/a.bag");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE((outcome.out + outcome.err).find("nowhere/a.bag: cannot be created"), std::string::npos);
}

constexpr const char* kRoom =
    "v -4 -3 0\nv 6 -3 0\nv 6 3 0\nv -4 3 0\nv -4 -3 2.8\nv 6 -3 2.8\nv 6 3 2.8\nv -4 3 2.8\n"
    "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string walk_along_x() {
  std::string text;
  for (int i = 0; i <= 100; ++i)
    text += std::to_string(0.02 * i) + " " + std::to_string(0.01 * i) + " 0 0 0 0 0 1\n";
  return text;
}

TEST_F(SimulateCommand, WalksThroughASceneOfOnesOwn) {
  std::ofstream(folder_ / "room.obj") << kRoom;
  std::ofstream(folder_ / "walk.tum") << walk_along_x();
  const Outcome outcome = simulate(
      "--mesh room.obj --trajectory walk.tum --trajectory-at -1,0.5,1.2 --trajectory-yaw-deg -90 "
      "--mount-error-deg 0.5,-1,2 --mount-error-mm=-5,0,10 -o own.bag");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("own.bag: room.obj for 2 s, 80 scans"), std::string::npos)
      << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("from the recorded poses (RMS)"), std::string::npos);
  const auto truth = nlohmann::json::parse(std::ifstream(folder_ / "own.truth.json"));
  EXPECT_EQ(truth["own_scene"]["at_m"], nlohmann::json({-1.0, 0.5, 1.2}));
  EXPECT_EQ(truth["options"]["mount_error_mm"], nlohmann::json({-5.0, 0.0, 10.0}));
}

TEST_F(SimulateCommand, RefusesAnOwnSceneThatIsNotPlain) {
  std::ofstream(folder_ / "room.obj") << kRoom;
  std::ofstream(folder_ / "open.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 5\n";
  std::ofstream(folder_ / "walk.tum") << walk_along_x();
  const std::string own = "--mesh room.obj --trajectory walk.tum -o a.bag ";
  for (const std::string& arguments :
       {"room-1 " + own, std::string("--trajectory walk.tum -o a.bag"), std::string("-o a.bag"),
        std::string("room-1 --trajectory walk.tum -o a.bag"), own + "--trajectory-at 1,2",
        own + "--trajectory-at 1,2,3,4", own + "--trajectory-at 1,2,z", own + "--trajectory-scale nan",
        own + "--mount-error-deg 1", own + "--trajectory-at 0,0,0.1",
        own + "--trajectory-at 0,0,1 --trajectory-scale 40"})
    EXPECT_EQ(simulate(arguments).exit_code, 2) << arguments;
  for (const char* arguments :
       {"--mesh open.obj -o a.bag", "--mesh none.ply -o a.bag",
        "--mesh room.obj --trajectory none.tum -o a.bag", "--mesh room.obj --trajectory room.obj -o a.bag"})
    EXPECT_EQ(simulate(arguments).exit_code, 3) << arguments;
  EXPECT_NE(simulate("--mesh open.obj -o a.bag").err.find("open.obj: line 4: "), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "a.bag"));
  EXPECT_FALSE(fs::exists(folder_ / "a.truth.json"));
}

}  // namespace
}  // namespace sweepscope
