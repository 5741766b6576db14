#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string output;  // of stdout and stderr
};

class SimulateCommand : public testing::Test {
 protected:
  SimulateCommand()
      : folder_(fs::temp_directory_path() / ("sweepscope-simulate-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~SimulateCommand() override { fs::remove_all(folder_); }

  Outcome simulate(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder_.string() + "' && " SWEEPSCOPE_EXECUTABLE " simulate " + arguments + " 2>&1";
    Outcome outcome;
    FILE* pipe = popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t read = std::fread(buffer.data(), 1, buffer.size(), pipe))
      outcome.output.append(buffer.data(), read);
    const int status = pclose(pipe);
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
  }

  fs::path folder_;
};

TEST_F(SimulateCommand, WritesTheBagAndItsTruth) {
  const Outcome outcome =
      simulate("metro-station -o walk.bag --duration-s 1.5 --offset-ms -7.5 --sweep-s 0.513");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("t_motor = t_laser - 7.5 ms"), std::string::npos) << outcome.output;
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
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(SimulateCommand, NamesTheScenesWhereOneIsUnknown) {
  EXPECT_NE(simulate("hall -o a.bag").output.find("the scenes are metro-station, parking-area, cemetery"),
            std::string::npos);
}

TEST_F(SimulateCommand, CannotWriteIntoAFolderThatIsNotThere) {
  const Outcome outcome = simulate("room-1 -o nowhere/a.bag");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.output.find("nowhere/a.bag: cannot be written"), std::string::npos);
}

}  // namespace
