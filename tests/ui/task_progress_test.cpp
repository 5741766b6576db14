#include "ui/jobs/task_progress.hpp"

#include <gtest/gtest.h>

#include "ui/jobs/task_plans.hpp"

namespace sweepscope::ui {
namespace {

TEST(TaskProgress, OpeningIsNotNearlyDoneWhenTheFirstReadingsOfTheBeamsAreTried) {
  TaskProgress progress(steps_of_loading());
  progress.report("reading", 1);
  for (int reading = 0; reading < 2; ++reading)
    for (const char* phase : {"features", "searching"}) progress.report(phase, 1);
  EXPECT_LT(progress.fraction(), 0.6);
}

TEST(TaskProgress, AddsItsStepsUpByTheirShares) {
  TaskProgress progress({{"reading", 1}, {"features", 3}});
  EXPECT_EQ(progress.fraction(), 0);
  progress.report("reading", 0.5);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.125);
  progress.report("reading", 1);
  progress.report("features", 0);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.25);
  progress.report("features", 1);
  EXPECT_DOUBLE_EQ(progress.fraction(), 1);
  EXPECT_EQ(progress.phase(), "features");
}

TEST(TaskProgress, AStepThatRepeatsGoesOnInsteadOfBeginningAgain) {
  TaskProgress progress({{"tracking", 1}, {"adjusting", 1}, {"tracking", 1}, {"adjusting", 1}});
  double before = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (const char* phase : {"tracking", "adjusting"}) {
      for (int i = 0; i <= 10; ++i) {
        progress.report(phase, i / 10.0);
        EXPECT_GE(progress.fraction(), before);
        before = progress.fraction();
      }
    }
    EXPECT_DOUBLE_EQ(progress.fraction(), pass == 0 ? 0.5 : 1);
  }
}

TEST(TaskProgress, TheSamePhaseTwiceInARowIsTwoSteps) {
  TaskProgress progress({{"candidates", 1}, {"candidates", 3}});
  progress.report("candidates", 1);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.25);
  progress.report("candidates", 0.1);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.325);
}

TEST(TaskProgress, WhatIsNotPlannedNeverReachesTheEnd) {
  TaskProgress progress;
  for (const char* phase : {"first", "second", "third", "fourth"}) {
    for (int i = 0; i <= 10; ++i) progress.report(phase, i / 10.0);
    EXPECT_LT(progress.fraction(), 1);
  }
  EXPECT_DOUBLE_EQ(progress.fraction(), 1 - 1 / 16.0);
}

TEST(TaskProgress, AStepThatIsLeftOutCountsAsDone) {
  TaskProgress progress({{"unpacking", 1}, {"reading", 1}, {"features", 2}});
  progress.report("features", 0);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.5);
}

TEST(TaskProgress, ReportsOutOfOrderDoNotLowerIt) {
  TaskProgress progress({{"tracking", 1}});
  progress.report("tracking", 0.5);
  progress.report("tracking", 0.48);
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.5);
}

}  // namespace
}  // namespace sweepscope::ui
