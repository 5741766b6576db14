// The list of recordings of one rig, and the answer from all of them.
#include <gtest/gtest.h>

#include <fstream>

#include "core/simulation/simulate.hpp"
#include "core/simulation/write_simulation.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/explorer/observables.hpp"

namespace sweepscope::ui {
namespace {

using test::perform, test::rest;

class SeveralRecordings : public testing::Test {
 protected:
  static std::string recorded(const char* scene, double offset_s) {
    const std::string path = test::scratch(std::string(scene) + ".bag").string();
    if (std::filesystem::exists(path)) return path;
    SimulationOptions options;
    options.scene = scene;
    options.offset_s = offset_s;
    options.sweep_s = 0.507;
    const auto made = simulate(options, Job());
    EXPECT_TRUE(made && write_bag(*made, path, Job()));
    return path;
  }

  void SetUp() override {
    perform(explorer_, "open " + first_);
    rest(explorer_);
    ASSERT_NE(explorer_.loaded(), nullptr);
  }

  std::string refusal_of(const std::string& line) {
    const auto done = explorer_.perform(line);
    EXPECT_FALSE(done) << line;
    return done ? "" : done.error().message;
  }

  const std::string first_ = recorded("room-1", 0.024), second_ = recorded("room-2", 0.024),
                    of_another_rig_ = recorded("room-4", 0.031);
  Explorer explorer_;
};

TEST_F(SeveralRecordings, GiveOneAnswerAndWhatEachSays) {
  perform(explorer_, "add-recording " + second_);
  EXPECT_EQ(explorer_.rig.files(), (std::vector<std::string>{first_, second_}));
  perform(explorer_, "estimate-together");
  EXPECT_TRUE(explorer_.rig.is_running());
  rest(explorer_);
  const Estimate* found = explorer_.estimating.found();
  ASSERT_NE(found, nullptr);
  ASSERT_TRUE(found->identifiable && found->together);
  EXPECT_NEAR(*found->offset_s, 0.024, 3 * *found->sigma_s);
  ASSERT_EQ(found->together->recordings.size(), 2U);
  EXPECT_LT(*found->sigma_s, *found->together->recordings[0].sigma_s);
  EXPECT_NEAR(explorer_.settings().offset_b_ms, 24, 0.1) << "map B is drawn with it";
}

TEST_F(SeveralRecordings, OneOfAnotherRigIsNamedAndCanBeLeftOut) {
  perform(explorer_, "add-recording " + second_);
  perform(explorer_, "add-recording " + of_another_rig_);
  perform(explorer_, "estimate-together");
  rest(explorer_);
  const Estimate* found = explorer_.estimating.found();
  ASSERT_TRUE(found != nullptr && found->together);
  EXPECT_FALSE(found->identifiable);
  EXPECT_NE(found->reasons().front().find("room-4.bag differs from the others by"), std::string::npos)
      << found->reasons().front();
  perform(explorer_, "leave-out 3");
  perform(explorer_, "estimate-together");
  rest(explorer_);
  EXPECT_TRUE(explorer_.estimating.found()->identifiable);
}

TEST_F(SeveralRecordings, TheListStaysWhileOneOfItIsOpen) {
  perform(explorer_, "add-recording " + second_);
  perform(explorer_, "open " + second_);
  rest(explorer_);
  EXPECT_EQ(explorer_.rig.files().size(), 2U);
  perform(explorer_, "open " + of_another_rig_);
  rest(explorer_);
  EXPECT_TRUE(explorer_.rig.files().empty());
}

TEST_F(SeveralRecordings, TheListEndsWithTheLastOther) {
  perform(explorer_, "add-recording " + second_);
  EXPECT_NE(refusal_of("leave-out 1").find("is open cannot be left out"), std::string::npos);
  perform(explorer_, "leave-out 2");
  EXPECT_TRUE(explorer_.rig.files().empty());
  EXPECT_EQ(refusal_of("leave-out 1"), "The list has no recording 1.");
  EXPECT_EQ(refusal_of("estimate-together"), "Add other recordings of this rig first.");
}

TEST_F(SeveralRecordings, WhatWasAddedIsNotWrittenOver) {
  perform(explorer_, "add-recording " + second_);
  const auto bytes = std::filesystem::file_size(second_);
  EXPECT_NE(refusal_of("save-session " + second_).find("is an input"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(second_), bytes);
}

TEST_F(SeveralRecordings, WhatCannotBeAddedIsRefusedInOneSentence) {
  EXPECT_EQ(refusal_of("add-recording " + first_), first_ + " is in the list already.");
  EXPECT_EQ(refusal_of("add-recording " + first_ + ".bak"), first_ + ".bak: there is no such file or folder");
  EXPECT_TRUE(explorer_.rig.files().empty());
  perform(explorer_, "sample room-1");
  rest(explorer_);
  EXPECT_NE(refusal_of("add-recording " + second_).find("Open a recording from a file first"),
            std::string::npos);
}

TEST_F(SeveralRecordings, AFileThatCannotBeReadIsNamedAndTheAnswerStays) {
  const std::string broken = test::scratch("broken.bag").string();
  std::ofstream(broken) << "#ROSBAG V2.0\nand then nothing of the kind";
  perform(explorer_, "estimate");
  rest(explorer_);
  perform(explorer_, "add-recording " + broken);
  perform(explorer_, "estimate-together");
  rest(explorer_);
  ASSERT_TRUE(explorer_.messages.shown());
  EXPECT_NE(explorer_.messages.shown()->text.find("broken.bag"), std::string::npos);
  ASSERT_NE(explorer_.estimating.found(), nullptr);
  EXPECT_FALSE(explorer_.estimating.found()->together);
}

}  // namespace
}  // namespace sweepscope::ui
