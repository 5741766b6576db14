#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/results/candidate_file.hpp"
#include "core/results/sealed_line.hpp"
#include "tests/app/self_signal.hpp"
#include "tests/program.hpp"

namespace sweepscope {
namespace {

using test::contents_of;

std::size_t line_count(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

class Shards : public test::ProgramTest {
 protected:
  void SetUp() override { make({"simulate room-2 -o room.bag"}); }
  std::string file(const std::string& name) const { return contents_of(folder_ / name); }
  void expect_done(const std::string& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  }

  /// Runs the command, which is killed once it has kept so many candidates.
  void kill_at(const std::string& arguments, int candidates) const {
    const test::SelfSignal killed{SIGKILL, "offset_ns", candidates};
    ASSERT_EQ(run(arguments, killed.environment()).exit_code, test::kKilled);
  }
};

constexpr const char* kSearch = "room.bag --method stationary --range 19:29:1 --range 23:25:0.2 ";

TEST_F(Shards, MergeToTheBytesOfOneRun) {
  const std::string search = kSearch;
  expect_done("estimate " + search + "--no-timing --json one.json --csv one.csv --threads 1");
  for (const char* shard : {"1/3", "2/3", "3/3"})
    expect_done("estimate " + search + "--threads 2 --shard " + shard);
  expect_done(
      "merge room.2-of-3.candidates room.3-of-3.candidates room.1-of-3.candidates --no-timing --json "
      "merged.json --csv merged.csv");
  EXPECT_GT(file("one.json").size(), 1000U);
  EXPECT_EQ(file("merged.json"), file("one.json"));
  EXPECT_EQ(file("merged.csv"), file("one.csv"));
  EXPECT_EQ(line_count(file("room.1-of-3.candidates")), 1U + 7U)
      << "a line for itself, and 19 / 3 candidates";
}

TEST_F(Shards, OfAWalkMergeToTheBytesOfOneRun) {
  expect_done("simulate metro-station -o walk.bag --duration-s 14");
  const std::string search = "walk.bag --method moving --around 24:0.5:6 ";
  const int exit_code = run("estimate " + search + "--no-timing --json one.json").exit_code;
  expect_done("estimate " + search + "--shard 1/2");
  expect_done("estimate " + search + "--shard 2/2");
  const Outcome merged =
      run("merge walk.1-of-2.candidates walk.2-of-2.candidates --no-timing --json merged.json");
  EXPECT_EQ(merged.exit_code, exit_code) << merged.err;
  EXPECT_NE(file("one.json").find("\"e_m\": 0."), std::string::npos);
  EXPECT_EQ(file("merged.json"), file("one.json"));
}

TEST_F(Shards, HaveTheSameBytesForAnyNumberOfThreads) {
  const std::string search = kSearch;
  expect_done("estimate " + search + "--shard 1/2 --threads 1 --resume one.candidates");
  expect_done("estimate " + search + "--shard 1/2 --threads 2 --resume two.candidates");
  EXPECT_EQ(file("one.candidates"), file("two.candidates"));
}

TEST_F(Shards, AKilledRunGoesOnWhereItWas) {
  const std::string search = "room.bag --method stationary --range 20:28:0.1 ";
  expect_done("estimate " + search + "--no-timing --json one.json --threads 1");
  kill_at("estimate " + search + "--resume kept.candidates --json resumed.json --threads 1", 15);
  const std::string kept = file("kept.candidates");
  ASSERT_LT(line_count(kept), 1U + 81U);
  EXPECT_FALSE(exists("resumed.json"));
  expect_done("estimate " + search + "--resume kept.candidates --no-timing --json resumed.json --threads 2");
  EXPECT_EQ(file("resumed.json"), file("one.json"));
  EXPECT_EQ(line_count(file("kept.candidates")), 1U + 81U) << "each candidate once";
}

TEST_F(Shards, TheDefaultSearchResumesToo) {
  expect_done("estimate room.bag --method stationary --no-timing --json one.json");
  kill_at("estimate room.bag --resume kept.candidates --threads 1", 15);
  expect_done("estimate room.bag --resume kept.candidates --no-timing --json resumed.json");
  EXPECT_EQ(file("resumed.json"), file("one.json"));
}

TEST_F(Shards, WhatIsKeptIsNotComputedAgain) {
  const std::string search = "room.bag --method stationary --range 20:28:1 ";
  expect_done("estimate " + search + "--resume kept.candidates");
  std::string kept = file("kept.candidates");
  const std::size_t begin = kept.rfind('\n', kept.find("\"offset_ns\":20000000,")) + 1;
  const std::size_t end = kept.find('\n', begin) + 1;
  auto line = nlohmann::ordered_json::parse(kept.substr(begin, end - begin));
  line.erase("hash");
  line["d"] = 77.25;
  kept.replace(begin, end - begin, sealed_line(line.dump()));
  std::ofstream(folder_ / "kept.candidates") << kept;
  expect_done("estimate " + search + "--resume kept.candidates --json -");
  EXPECT_NE(file("said.out").find("\"d\": 77.25"), std::string::npos) << "the kept value, whatever it is";
}

TEST_F(Shards, ALineThatWasNotWrittenToItsEndIsComputedAgain) {
  const std::string search = "room.bag --method stationary --range 20:28:1 ";
  expect_done("estimate " + search + "--no-timing --json one.json --resume kept.candidates");
  const std::string whole = file("kept.candidates");
  std::filesystem::resize_file(folder_ / "kept.candidates", whole.size() - 7);
  expect_done("estimate " + search + "--no-timing --json two.json --resume kept.candidates");
  EXPECT_EQ(file("two.json"), file("one.json"));
  EXPECT_EQ(file("kept.candidates"), whole);
}

TEST_F(Shards, CandidatesOfAnotherSearchOrRecordingAreRefused) {
  expect_done("estimate room.bag --method stationary --range 20:28:1 --resume kept.candidates");
  const std::string kept = file("kept.candidates");
  const Outcome other = run("estimate room.bag --method stationary --range 20:28:2 --resume kept.candidates");
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("kept.candidates: it contains --method=stationary --range=20:28:1"),
            std::string::npos)
      << other.err;
  expect_done("simulate room-3 -o other.bag");
  EXPECT_EQ(run("estimate other.bag --method stationary --range 20:28:1 --resume kept.candidates").exit_code,
            2);
  EXPECT_EQ(run("estimate room.bag --method stationary --range 20:28:1 --resume kept.candidates --shard 1/2")
                .exit_code,
            2);
  EXPECT_EQ(file("kept.candidates"), kept);
  EXPECT_EQ(run("estimate room.bag --range 20:28:1 --resume other.bag").exit_code, 3)
      << "no file of candidates";
}

TEST_F(Shards, AMergeWithoutAllPartsSaysWhichAreMissing) {
  const std::string search = kSearch;
  expect_done("estimate " + search + "--shard 1/3");
  expect_done("estimate " + search + "--shard 3/3");
  const Outcome outcome = run("merge room.1-of-3.candidates room.3-of-3.candidates --json merged.json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("6 candidates are missing, the first at 20 ms; no file has shard 2/3"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(exists("merged.json"));
}

TEST_F(Shards, AMergeFindsTheRecordingWhereItIsSaidToBe) {
  expect_done("estimate room.bag --method stationary --range 20:28:1 --no-timing --json one.json");
  expect_done("estimate room.bag --method stationary --range 20:28:1 --shard 1/1");
  std::filesystem::rename(folder_ / "room.bag", folder_ / "moved.bag");
  EXPECT_EQ(run("merge room.1-of-1.candidates").exit_code, 3);
  expect_done("merge room.1-of-1.candidates --recording moved.bag --no-timing --json merged.json");
  EXPECT_EQ(file("merged.json"), file("one.json"));
  expect_done("simulate room-3 -o other.bag");
  EXPECT_EQ(run("merge room.1-of-1.candidates --recording other.bag").exit_code, 2);
}

TEST_F(Shards, WrongUsageIsRefused) {
  EXPECT_EQ(run("estimate room.bag --range 20:28:1 --shard 0/2").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --range 20:28:1 --shard 3/2").exit_code, 2);
  EXPECT_EQ(run("estimate room.bag --range 20:28:1 --shard 1/2 --json a.json").exit_code, 2);
  const Outcome outcome = run("estimate room.bag --shard 1/2");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("chooses its candidates as it goes"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("room.1-of-2.candidates"));
  EXPECT_EQ(run("estimate room.bag --method direct --resume kept.candidates").exit_code, 2);
  EXPECT_EQ(run("merge").exit_code, 2);
  EXPECT_EQ(run("merge room.bag").exit_code, 3);
}

TEST_F(Shards, RunUnderGnuParallel) {
  if (std::system("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "GNU parallel is not installed";
  expect_done("estimate " + std::string(kSearch) + "--no-timing --json one.json");
  const Outcome four =
      test::run_shell(folder_, "parallel --will-cite -j2 " SWEEPSCOPE_EXECUTABLE " estimate " +
                                   std::string(kSearch) + "--threads 1 --shard {}/4 ::: 1 2 3 4");
  ASSERT_EQ(four.exit_code, 0) << four.err;
  expect_done(
      "merge room.1-of-4.candidates room.2-of-4.candidates room.3-of-4.candidates room.4-of-4.candidates "
      "--no-timing --json merged.json");
  EXPECT_EQ(file("merged.json"), file("one.json"));
}

TEST_F(Shards, AFileOfCandidatesBelongsToOneRunAtATime) {
  const std::string resumed =
      "estimate room.bag --method stationary --range 20:28:1 --resume kept.candidates";
  expect_done(resumed);
  const Outcome second =
      test::run_shell(folder_, "flock kept.candidates " SWEEPSCOPE_EXECUTABLE " " + resumed);
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_NE(second.err.find("another run is writing it"), std::string::npos) << second.err;
}

}  // namespace
}  // namespace sweepscope
