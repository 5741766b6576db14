// Poses from elsewhere (--poses) that do not cover the recording, through the shipped executable.
#include <gtest/gtest.h>

#include "tests/program.hpp"

namespace sweepscope {
namespace {

class Poses : public test::ProgramTest {
 protected:
  void SetUp() override {
    make({"simulate room-3 -o r.bag --duration-s 4"});
    // The truth of a room begins with the recording, at a time of today.
    const std::string truth = test::contents_of(folder_ / "r.truth.tum");
    const std::size_t first = truth.find('\n') + 1;
    begin_s_ = std::stoll(truth.substr(first, truth.find('.', first) - first));
  }
  void write_poses(const std::string& name, long long from_s, long long to_s) const {
    std::ofstream file(folder_ / name);
    for (const long long time_s : {from_s, to_s}) file << time_s << ".0 0 0 0 0 0 0 1\n";
  }

  long long begin_s_ = 0;
};

TEST_F(Poses, OfAnotherTimeAreExitCode4WithBothSpans) {
  write_poses("other.tum", 100, 110);
  for (const char* arguments :
       {"map r.bag --offset-ms 24 -o out.pcd --poses other.tum",
        "compare r.bag --offsets-ms 19,24 --no-curve -o out.png --poses other.tum",
        "view r.bag --poses other.tum --headless --no-estimate --run 'wait solved; screenshot out.png'"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 4) << arguments << ": " << outcome.err;
    EXPECT_NE(outcome.err.find("r.bag: no scan lies within the time of the poses: the poses are from 100.000 "
                               "to 110.000 s, the scans from " +
                               std::to_string(begin_s_)),
              std::string::npos)
        << outcome.err;
    EXPECT_FALSE(exists("out.pcd") || exists("out.png"));
  }
}

TEST_F(Poses, OfAPartOfTheTimeAreUsedWithAWarning) {
  write_poses("part.tum", begin_s_ - 10, begin_s_ + 2);
  for (const char* arguments : {"map r.bag --offset-ms 24 -o out.pcd --poses part.tum",
                                "compare r.bag --offsets-ms 19,24 --no-curve -o out.png --poses part.tum"}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << arguments << ": " << outcome.err;
    EXPECT_EQ(outcome.err.rfind("warning: ", 0), 0U) << outcome.err;
    EXPECT_NE(outcome.err.find(" scans lie outside the time of the poses, from "), std::string::npos)
        << outcome.err;
  }
  write_poses("whole.tum", begin_s_ - 10, begin_s_ + 10);
  EXPECT_EQ(run("map r.bag --offset-ms 24 -o out.pcd --poses whole.tum").err, "");
}

TEST_F(Poses, AreRefusedWhereTheyMakeNoSense) {
  write_poses("whole.tum", begin_s_ - 10, begin_s_ + 10);
  const Outcome alone = run("estimate r.bag --trust-poses");
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("--trust-poses needs --poses"), std::string::npos) << alone.err;
  const Outcome moving = run("estimate r.bag --poses whole.tum --method moving");
  EXPECT_EQ(moving.exit_code, 2);
  EXPECT_NE(moving.err.find("--poses is used by the direct method only"), std::string::npos) << moving.err;
  const Outcome standing = run("estimate r.bag --poses whole.tum");
  EXPECT_EQ(standing.exit_code, 2);
  EXPECT_NE(standing.err.find("poses are not used for a stationary rig"), std::string::npos) << standing.err;
  std::ofstream(folder_ / "one.tum") << begin_s_ << ".0 0 0 0 0 0 0 1\n";
  const Outcome one = run("estimate r.bag --poses one.tum");
  EXPECT_EQ(one.exit_code, 3);
  EXPECT_NE(one.err.find("one.tum: a trajectory needs at least two poses"), std::string::npos) << one.err;
}

}  // namespace
}  // namespace sweepscope
