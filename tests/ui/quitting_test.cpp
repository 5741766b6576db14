// What quitting waits for: work looks whether it is cancelled in each of its long steps, by count and not by
// time.
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <optional>
#include <thread>

#include "render/report/gather_report.hpp"
#include "tests/ui/explorer_fixtures.hpp"
#include "ui/model/places.hpp"
#include "ui/script/script.hpp"

namespace sweepscope::ui {
namespace {

class CancelledWork : public test::InARoom {
 protected:
  void SetUp() override {
    InARoom::SetUp();
    job_.cancel();
    const auto& loaded = explorer_.recording.loaded();
    a_ = {loaded, explorer_.pane(Side::kA).request->placement.map, 0};
    b_ = {loaded, a_.map, 0.024};
  }
  Job job_;
  Placement a_, b_;
};

TEST_F(CancelledWork, PlacesNoPoints) {
  EXPECT_FALSE(place_cloud(a_, {}, false).beams.empty());
  EXPECT_TRUE(place_cloud(a_, {}, false, nullptr, nullptr, job_).beams.empty());
}

TEST_F(CancelledWork, DescribesNoMap) {
  EXPECT_TRUE(map_without_solving(*a_.loaded, true, 0, job_)->order.all.empty());
}

TEST_F(CancelledWork, MeasuresNoWalls) {
  EXPECT_FALSE(slow_values(a_, ColourBy::kBlur, nullptr, job_).thickness);
}

TEST_F(CancelledWork, ComparesNoMaps) {
  EXPECT_TRUE(find_places(a_, b_, job_).empty());
}

TEST_F(CancelledWork, WritesNoReport) {
  ReportContent content;
  content.recording = a_.loaded->summary;
  const auto folder = test::scratch("cancelled-report");
  const auto written = write_report(content, folder, job_);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kInterrupted);
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
}

// Cancelled half-way through its looks, a step ends within a few more.
TEST_F(CancelledWork, EndsSoonWhereverItIsStopped) {
  const auto looks_after = [&](const auto& work) {
    LookCount all(std::numeric_limits<std::uint64_t>::max());
    Job whole;
    whole.obey(all);
    work(whole);
    EXPECT_GE(all.looks(), 4u) << "it hardly looks";
    LookCount half(all.looks() / 2);
    Job stopped;
    stopped.obey(half);
    work(stopped);
    return half.looks() < all.looks();
  };
  EXPECT_TRUE(looks_after([&](const Job& job) { (void)slow_values(a_, ColourBy::kBlur, nullptr, job); }));
  EXPECT_TRUE(looks_after([&](const Job& job) { (void)find_places(a_, b_, job); }));
}

class QuittingWhileAFileIsWritten : public testing::Test {
 protected:
  void SetUp() override {
    ui_.frame({}, 0.01);
    ui_.explorer().exports.start(
        {.title = "Writing", .done = "Written.", .file = "x", .write = [this](const Job& job) {
           begun_ = true;
           while (!job.cancelled() && !written_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
           stopped_ = job.cancelled();
           return Result<void>();
         }});
  }
  std::atomic<bool> begun_ = false, written_ = false, stopped_ = false;
  std::unique_ptr<gl::Context> context_ = *gl::make_offscreen_context(600, 400);
  std::optional<Ui> owned_{std::in_place, *context_, Ui::Options()};
  Ui& ui_ = *owned_;
};

TEST_F(QuittingWhileAFileIsWritten, WaitsForItAndSaysSo) {
  ui_.quit();
  EXPECT_FALSE(ui_.wants_quit());
  ASSERT_TRUE(ui_.explorer().messages.shown());
  EXPECT_NE(ui_.explorer().messages.shown()->text.find("Quit again"), std::string::npos);
  written_ = true;
  while (ui_.is_exporting()) ui_.frame({}, 0.01);
  EXPECT_TRUE(ui_.wants_quit());
  EXPECT_FALSE(stopped_);
}

TEST_F(QuittingWhileAFileIsWritten, StopsItTheSecondTime) {
  while (!begun_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ui_.quit();
  ui_.quit();
  EXPECT_TRUE(ui_.wants_quit());
  owned_.reset();
  EXPECT_TRUE(stopped_);
}

}  // namespace
}  // namespace sweepscope::ui
