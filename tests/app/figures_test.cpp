#include <gtest/gtest.h>

#include <chrono>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class FiguresCommand : public test::ProgramTest {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "recipe.yaml")
        << "look: {size: 800x600}\n"
           "recordings: {room: {simulate: room-2, offset_ms: 7, duration_s: 4}}\n"
           "estimates: {room: {recording: room, method: stationary, ranges_ms: [[2, 12, 1]]}}\n"
           "figures:\n"
           "  scan: {kind: scan, recording: room, at_s: 1, formats: [png, svg, pdf]}\n"
           "  curve: {kind: curves, estimates: room}\n"
           "  maps:\n"
           "    kind: maps\n"
           "    maps: [{recording: room, offset_ms: 2}, {recording: room, offset_ms: 7, points: features}]\n"
           "    estimate: room\n"
           "tables:\n"
           "  offsets: {estimates: [room], columns: [{title: o, unit: ms, value: offset}, "
           "{title: truth, unit: ms, value: truth}]}\n";
  }
  std::string file(const std::string& name) const { return test::contents_of(folder_ / name); }
};

TEST_F(FiguresCommand, MakesEveryFigureAndTableWithItsOrigin) {
  const Outcome outcome = run("figures recipe.yaml -o out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "out/scan.png\nout/scan.svg\nout/scan.pdf\nout/curve.png\nout/maps.png\n"
            "out/offsets.csv\nout/offsets.md\nout/offsets.tex\n");
  for (const char* name : {"scan.png", "scan.svg", "scan.pdf", "curve.png", "maps.png"}) {
    EXPECT_GT(file(std::string("out/") + name).size(), 3'000U) << name;
  }
  EXPECT_NE(file("out/maps.png").find("recipe.yaml, maps"), std::string::npos);
  EXPECT_NE(file("out/maps.png").find("room at 2.0 ms; room at 7.0 ms"), std::string::npos);
  EXPECT_EQ(file("out/offsets.csv"), "o_ms,truth_ms\n7,7\n");
}

TEST_F(FiguresCommand, ASecondRunDrawsTheSameBytesWithoutEstimatingAgain) {
  ASSERT_EQ(run("figures recipe.yaml -o out").exit_code, 0);
  const std::string first = file("out/curve.png") + file("out/maps.png");
  const Outcome again = run("figures recipe.yaml -o out --threads 1");
  ASSERT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err.find("estimate room"), std::string::npos) << again.err;
  EXPECT_EQ(file("out/curve.png") + file("out/maps.png"), first);
}

TEST_F(FiguresCommand, AnotherRecordingIsEstimatedAnew) {
  ASSERT_EQ(run("figures recipe.yaml -o out").exit_code, 0);
  std::string recipe = file("recipe.yaml");
  recipe.replace(recipe.find("offset_ms: 7"), 12, "offset_ms: 9");
  std::ofstream(folder_ / "recipe.yaml") << recipe;
  ASSERT_EQ(run("figures recipe.yaml -o out").exit_code, 0);
  EXPECT_EQ(file("out/offsets.csv"), "o_ms,truth_ms\n9,9\n");
}

TEST_F(FiguresCommand, AWrongRecipeIsExitThreeWithThePlace) {
  std::ofstream(folder_ / "wrong.yaml") << "figures:\n  a: {kind: pie}\n";
  const Outcome outcome = run("figures wrong.yaml -o out");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("wrong.yaml:2:13: figure a: kind must be one of"), std::string::npos)
      << outcome.err;
  EXPECT_FALSE(exists("out"));
  EXPECT_EQ(run("figures absent.yaml -o out").exit_code, 3);
}

TEST_F(FiguresCommand, WhatWasFinishedStaysWhenALaterFigureFails) {
  std::ofstream(folder_ / "part.yaml")
      << "recordings: {room: {simulate: room-2, duration_s: 3}, gone: {file: gone.bag}}\n"
         "figures:\n"
         "  first: {kind: scan, recording: room, at_s: 1}\n"
         "  second: {kind: scan, recording: gone, at_s: 1}\n";
  const Outcome outcome = run("figures part.yaml -o out");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("part.yaml: second: "), std::string::npos) << outcome.err;
  EXPECT_TRUE(exists("out/first.png"));
}

}  // namespace
}  // namespace sweepscope
