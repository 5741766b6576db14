// No command writes over what it reads, nor twice to one file.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// A command line with the names of its inputs in braces, and {OUT} where one of its outputs goes.
struct Slot {
  const char* name;
  const char* arguments;
  const char* extension;            // of the output
  const char* in_folder = nullptr;  // {OUT} is a folder, and this the file in it
};

std::ostream& operator<<(std::ostream& out, const Slot& slot) {
  return out << slot.name;
}

constexpr Slot kSlots[] = {
    {"info_json", "info {REC} --rig {RIG} --json {OUT}", ".json"},
    {"rig", "rig {REC} --rig {RIG} -o {OUT}", ".yaml"},
    {"convert_bag", "convert {REC} --rig {RIG} -o {OUT}", ".bag"},
    {"convert_mcap", "convert {REC} --rig {RIG} -o {OUT}", ".mcap"},
    {"convert_tables", "convert {REC} --rig {RIG} -o {OUT} --to csv", "", "motor.csv"},
    {"estimate_json", "estimate {REC} --rig {RIG} --json {OUT}", ".json"},
    {"estimate_csv", "estimate {REC} --rig {RIG} --csv {OUT}", ".csv"},
    {"estimate_resume", "estimate {REC} --rig {RIG} --range 23:25:1 --resume {OUT}", ".candidates"},
    {"estimate_table", "estimate {REC} --rig {RIG} --table {OUT}", ".csv"},
    {"estimate_trend", "estimate {REC} --rig {RIG} --trend {OUT}", ".svg"},
    {"rig_as", "rig {REC} --rig {RIG} --as urdf --estimate {ESTIMATE} -o {OUT}", ".urdf"},
    {"merge_json", "merge {PART} --rig {RIG} --recording {REC} --json {OUT}", ".json"},
    {"merge_csv", "merge {PART} --rig {RIG} --recording {REC} --csv {OUT}", ".csv"},
    {"map", "map {REC} --rig {RIG} --offset-ms 24 --poses {POSES} -o {OUT}", ".pcd"},
    {"map_trajectory", "map {REC} --rig {RIG} --offset-ms 24 --poses {POSES} -o new.pcd --trajectory {OUT}",
     ".tum"},
    {"compare", "compare {REC} --rig {RIG} --poses {POSES} --curve {ESTIMATE} --offsets-ms 19,24 -o {OUT}",
     ".png"},
    {"compare_json",
     "compare {REC} --rig {RIG} --poses {POSES} --curve {ESTIMATE} --offsets-ms 19,24 -o p.png --json {OUT}",
     ".json"},
    {"figures", "figures {RECIPE} -o {OUT}", "", "scan.png"},
    {"report", "report {REC} --rig {RIG} -o {OUT}", "", "report.html"},
    {"report_json", "report {REC} --rig {RIG} -o {OUT}", "", "estimate.json"},
    {"calibrate_json", "calibrate - --rig {RIG} --json {OUT} <{REC}", ".json"},
    {"calibrate_record", "calibrate - --rig {RIG} --record {OUT} <{REC}", ".bag"},
    {"simulate", "simulate --mesh {MESH} --trajectory {POSES} -o {OUT}", ".bag"},
    {"view_session",
     "view {REC} --rig {RIG} --poses {POSES} --headless --no-estimate --run 'save-session {OUT}'",
     ".session"},
    {"view_picture",
     "view {REC} --rig {RIG} --poses {POSES} --headless --no-estimate --run 'export-picture {OUT}'", ".png"},
    {"view_screenshot",
     "view {REC} --rig {RIG} --poses {POSES} --headless --no-estimate --run 'screenshot {OUT}'", ".png"},
    {"view_cloud",
     "view {REC} --rig {RIG} --poses {POSES} --headless --no-estimate --run 'export-cloud a {OUT}'", ".ply"},
    {"view_curve",
     "view {SESSION} --rig {RIG} --headless --no-estimate --script {SCRIPT} --run 'export-curve {OUT}'",
     ".json"},
    {"view_rig",
     "view {REC} --rig {RIG} --headless --no-estimate --run 'solve-for offset,mount; estimate; wait estimated; export-rig "
     "{OUT}'",
     ".yaml"},
    {"view_report", "view {REC} --rig {RIG} --headless --no-estimate --run 'export-report {OUT}'", "",
     "report.html"},
};

class OutputsOntoInputs : public test::ProgramTest, public ::testing::WithParamInterface<Slot> {
 protected:
  static void TearDownTestSuite() { fs::remove_all(made_); }
  void SetUp() override {
    if (made_.empty()) {
      make_inputs();
      made_ = folder_.string() + "-inputs";
      fs::copy(folder_, made_);
    }
    for (const auto& [name, file] : inputs_)
      fs::copy(made_ / file, folder_ / file, fs::copy_options::overwrite_existing);
  }

  void make_inputs() const {
    make({"simulate room-1 --duration-s 2 -o room.bag"});
    ASSERT_EQ(run("rig room.bag -o rig.yaml").exit_code, 0);
    fs::rename(folder_ / "room.truth.tum", folder_ / "poses.tum");
    ASSERT_EQ(run("estimate room.bag --rig rig.yaml --method stationary --range 23:25:1 --json estimate.json")
                  .exit_code,
              0);
    ASSERT_EQ(run("estimate room.bag --rig rig.yaml --range 23:25:1 --shard 1/1 --resume part").exit_code, 0);
    std::ofstream(folder_ / "recipe.yaml") << "recordings: {room: {file: room.bag, rig: rig.yaml}}\n"
                                              "estimates: {room: {file: estimate.json, recording: room}}\n"
                                              "figures: {scan: {kind: scan, recording: room, at_s: 1}}\n";
    std::ofstream(folder_ / "view.script") << "wait loaded\n";
    std::ofstream(folder_ / "mesh.ply") << "ply\n";
    ASSERT_EQ(run("view room.bag --headless --no-estimate --run 'wait loaded; save-session session.json'")
                  .exit_code,
              0);
  }

  inline static fs::path made_;  // the inputs, once for all
  const std::map<std::string, std::string> inputs_{{"REC", "room.bag"},           {"RIG", "rig.yaml"},
                                                   {"POSES", "poses.tum"},        {"PART", "part"},
                                                   {"ESTIMATE", "estimate.json"}, {"RECIPE", "recipe.yaml"},
                                                   {"SESSION", "session.json"},   {"SCRIPT", "view.script"},
                                                   {"MESH", "mesh.ply"}};

  static std::string with(std::string text, const std::string& name, const std::string& value) {
    const std::string token = "{" + name + "}";
    for (std::size_t at = 0; (at = text.find(token)) != text.npos;) text.replace(at, token.size(), value);
    return text;
  }
  /// Makes the slot's output another name of the input `name`, and gives the command line.
  std::string onto(const std::string& name, const std::string& kind) {
    const Slot& slot = GetParam();
    const std::string out = "onto-" + name + "-" + kind + slot.extension;
    fs::path file = folder_ / out;
    if (slot.in_folder != nullptr) {
      fs::create_directory(folder_ / out);
      file /= slot.in_folder;
    }
    std::string arguments = with(slot.arguments, "OUT", out);
    const fs::path input = folder_ / inputs_.at(name);
    if (kind == "hard") fs::create_hard_link(input, file);
    if (kind == "soft") fs::create_symlink(input, file);
    if (kind == "name") {
      fs::copy_file(input, file);
      arguments = with(arguments, name, fs::relative(file, folder_).string());
    }
    for (const auto& [other, path] : inputs_) arguments = with(arguments, other, path);
    return arguments;
  }
};

TEST_P(OutputsOntoInputs, AreRefusedBeforeAnyWork) {
  std::map<std::string, std::string> before;
  for (const auto& [name, path] : inputs_) before[name] = test::contents_of(folder_ / path);
  for (const auto& [name, path] : inputs_) {
    if (std::string(GetParam().arguments).find("{" + name + "}") == std::string::npos) continue;
    for (const char* kind : {"name", "hard", "soft"}) {
      const std::string arguments = onto(name, kind);
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.out << outcome.err;
      EXPECT_NE(outcome.err.find("overwritten"), std::string::npos) << arguments << "\n" << outcome.err;
      for (const auto& [other, file] : inputs_)
        ASSERT_EQ(test::contents_of(folder_ / file), before[other]) << arguments << " changed " << file;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryCommand, OutputsOntoInputs, ::testing::ValuesIn(kSlots),
                         [](const auto& one) { return one.param.name; });

class OutputFiles : public test::ProgramTest {
 protected:
  void SetUp() override { make({"simulate room-1 --duration-s 2 -o room.bag"}); }
};

TEST_F(OutputFiles, TablesOfARecordingsFolderAreInputs) {
  ASSERT_EQ(run("convert room.bag -o tables").exit_code, 0);
  const std::string before = test::contents_of(folder_ / "tables/motor.csv");
  for (const char* arguments :
       {"estimate tables --csv tables/motor.csv", "info tables --json tables/scans.csv",
        "convert tables -o tables --to csv", "rig tables -o tables/motor.csv"})
    EXPECT_EQ(run(arguments).exit_code, 2) << arguments;
  EXPECT_EQ(test::contents_of(folder_ / "tables/motor.csv"), before);
  EXPECT_EQ(run("info tables --json tables/info.json").exit_code, 0)
      << "a new file in the folder is no input";
  EXPECT_EQ(run("info tables --json tables/info.json").exit_code, 0) << "nor is it the second time";
}

TEST_F(OutputFiles, AreNotTheSameFile) {
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.err;
    return outcome.err;
  };
  refused("estimate room.bag --json out --csv out");
  refused("estimate room.bag --json out --csv ./out");
  refused("estimate room.bag --range 23:25:1 --resume out --json out");
  EXPECT_NE(refused("estimate room.bag --json - --csv -").find("standard output"), std::string::npos);
  refused("map room.bag --offset-ms 24 -o out.pcd --trajectory out.pcd");
  fs::create_symlink("out.ply", folder_ / "link.tum");
  refused("map room.bag --offset-ms 24 -o out.ply --trajectory link.tum");
  refused("calibrate - --json out.bag --record out.bag </dev/null");
  EXPECT_FALSE(exists("out") || exists("out.pcd") || exists("out.ply") || exists("out.bag"));
}

TEST_F(OutputFiles, ASessionIsSavedWhereItWasOpened) {
  ASSERT_EQ(run("view room.bag --headless --no-estimate --run 'wait loaded; save-session s.json'").exit_code,
            0);
  const Outcome outcome =
      run("view s.json --headless --no-estimate --run 'wait loaded; offset-a 20; save-session s.json'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(test::contents_of(folder_ / "s.json").find("20"), std::string::npos);
}

TEST_F(OutputFiles, BagsArePutIntoDevicesAndPipesAsTheyAre) {
  EXPECT_EQ(run("convert room.bag -o /dev/null --to ros1").exit_code, 0);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const std::string piped =
      "mkfifo pipe && { '" SWEEPSCOPE_EXECUTABLE
      "' convert room.bag -o pipe --to ros1 >/dev/null & cat pipe >through.bag; wait; }";
  ASSERT_EQ(test::run_shell(folder_, piped).exit_code, 0);
  ASSERT_TRUE(fs::is_fifo(folder_ / "pipe"));
  ASSERT_EQ(run("convert room.bag -o whole.bag").exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "through.bag"), test::contents_of(folder_ / "whole.bag"));
  fs::create_symlink("linked.bag", folder_ / "link.bag");
  EXPECT_EQ(run("convert room.bag -o link.bag").exit_code, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.bag"));
  EXPECT_EQ(test::contents_of(folder_ / "linked.bag"), test::contents_of(folder_ / "whole.bag"));
}

TEST_F(OutputFiles, AreEachWholeWhenEqualRunsWriteThemAtOnce) {
  ASSERT_EQ(run("convert room.bag -o whole.bag").exit_code, 0);
  std::ofstream(folder_ / "out.bag.part") << "someone else's";
  const std::string program = "'" SWEEPSCOPE_EXECUTABLE "' convert room.bag -o out.bag";
  const std::string at_once = "( for i in 1 2 3 4 5 6; do " + program + " & done; wait )";
  ASSERT_EQ(test::run_shell(folder_, at_once).exit_code, 0);
  EXPECT_EQ(test::contents_of(folder_ / "out.bag"), test::contents_of(folder_ / "whole.bag"));
  EXPECT_EQ(test::contents_of(folder_ / "out.bag.part"), "someone else's");
}

/// The writers of bags, at limits of a file's size from nothing to more than they need.
TEST_F(OutputFiles, ABagThatDoesNotFitIsRefusedWhateverItsSize) {
  constexpr long kBlock_bytes = 512;  // of ulimit -f
  const auto whole = static_cast<long>(fs::file_size(folder_ / "room.bag"));
  std::ofstream(folder_ / "old.bag") << "old";
  for (const char* command : {"simulate room-1 --duration-s 2", "convert room.bag"}) {
    for (long blocks = 0; blocks * kBlock_bytes < whole; blocks += whole / kBlock_bytes / 12) {
      const std::string limited = "( ulimit -f " + std::to_string(blocks) +
                                  "; exec '" SWEEPSCOPE_EXECUTABLE "' " + command +
                                  " -o old.bag ) 2>&1 >/dev/null; echo $?";
      ASSERT_EQ(std::system(("cd '" + folder_.string() + "' && { " + limited + "; } | cat >said").c_str()),
                0);
      const std::string said = test::contents_of(folder_ / "said");
      EXPECT_NE(said.find("old.bag: cannot be written: File too large\n2\n"), std::string::npos)
          << blocks << " blocks: " << said;
      EXPECT_EQ(test::contents_of(folder_ / "old.bag"), "old");
    }
  }
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

}  // namespace
}  // namespace sweepscope
