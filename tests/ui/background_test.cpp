#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "ui/jobs/background.hpp"

namespace sweepscope::ui {
namespace {

TEST(Background, ACancelledTaskIsForgottenAndTheNextOneRuns) {
  Background background;
  std::atomic<bool> saw_cancel = false;
  bool first_finished = false, second_finished = false;
  std::atomic<bool> started = false;
  background.start("lane", "first", "First", [&](const Job& job) {
    started = true;
    while (!job.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    saw_cancel = true;
    return [&] { first_finished = true; };
  });
  background.start("lane", "second", "Second", [&](const Job&) { return [&] { second_finished = true; }; });
  EXPECT_TRUE(background.has("first"));
  while (!started) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  background.cancel("first");
  EXPECT_FALSE(background.has("first"));
  while (background.busy()) {
    background.take_finished();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(saw_cancel);
  EXPECT_FALSE(first_finished);
  EXPECT_TRUE(second_finished);
}

TEST(Background, ProgressIsSeenFromOutside) {
  std::atomic<bool> go_on = false;  // outlives the work that waits for it
  Background background;
  background.start("lane", "key", "Title", [&](const Job& job) -> Background::Finish {
    job.report("phase", 0.5);
    while (!go_on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return {};
  });
  while (background.status().empty() || background.status()[0].fraction == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(background.status()[0].title, "Title");
  EXPECT_EQ(background.status()[0].phase, "phase");
  go_on = true;
}

}  // namespace
}  // namespace sweepscope::ui
