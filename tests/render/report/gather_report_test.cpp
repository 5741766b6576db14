#include "render/report/gather_report.hpp"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>

#include "core/map/consistency/map_consistency.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/every_look.hpp"
#include "tests/render/synthetic_maps.hpp"

namespace sweepscope {
namespace {

class InMemory : public CandidateStore {
 public:
  std::optional<CurvePoint> find(double offset_s) override {
    const std::scoped_lock lock(mutex_);
    const auto found = points_.find(offset_s);
    return found == points_.end() ? std::nullopt : std::optional(found->second);
  }
  void keep(const CurvePoint& point) override {
    const std::scoped_lock lock(mutex_);
    points_.emplace(point.offset_s, point);
  }
  std::optional<Error> failed() const override { return std::nullopt; }
  std::size_t size() const { return points_.size(); }

 private:
  std::mutex mutex_;
  std::map<double, CurvePoint> points_;
};

PreparedRecording short_recording() {
  return prepare(test::simulated("room-1", 0.024, 2.5).recording, FeatureOptions(), Job()).value();
}

// None where it says that it was interrupted.
std::optional<std::string> html(const PreparedRecording& prepared, CandidateStore* kept, const Job& job) {
  auto page = gather_report(prepared, {}, kept, job).and_then([&](const ReportContent& content) {
    return report_html(content, job);
  });
  if (page) return std::move(*page);
  EXPECT_EQ(page.error().code, ExitCode::kInterrupted);
  return std::nullopt;
}

// With the candidates of a report before it: they take two thirds of its time.
TEST(GatherReport, InterruptedAtAnyLookItGivesNothing) {
  const PreparedRecording prepared = short_recording();
  InMemory kept;
  ASSERT_TRUE(html(prepared, &kept, Job()));
  test::expect_interrupted_at_every_look(5, [&](const Job& job) { return html(prepared, &kept, job); });
}

TEST(GatherReport, InterruptedAmongTheCandidatesItGivesNothing) {
  struct CancelsAfterAFew : InMemory {
    explicit CancelsAfterAFew(Job& to_cancel) : job(to_cancel) {}
    void keep(const CurvePoint& point) override {
      InMemory::keep(point);
      if (++kept == 5) job.cancel();
    }
    Job& job;
    std::atomic<int> kept{0};
  };
  const PreparedRecording prepared = short_recording();
  InMemory whole;
  ASSERT_TRUE(html(prepared, &whole, Job()));
  Job job;
  CancelsAfterAFew some(job);
  EXPECT_FALSE(html(prepared, &some, job));
  EXPECT_GE(some.size(), 5U);
  EXPECT_LT(some.size(), whole.size());
}

// One rule for every part of the program: the report's headline is what `estimate` prints.
TEST(GatherReport, ItsAnswerIsThatOfAnEstimateAndTheCriteriaStandBesideIt) {
  const PreparedRecording prepared =
      prepare(test::simulated("room-1", 0.024, 4.5).recording, FeatureOptions(), Job()).value();
  const ReportContent content = gather_report(prepared, {}, nullptr, Job()).value();
  const Estimate found = estimate(prepared, {}, {}, Job()).value();
  EXPECT_EQ(content.estimate.method, Method::kDirect);
  EXPECT_EQ(content.estimate.offset_s, found.offset_s);
  EXPECT_EQ(content.estimate.sigma_s, found.sigma_s);
  ASSERT_TRUE(content.criteria);
  EXPECT_EQ(content.criteria->method, Method::kStationary);
  ASSERT_EQ(content.maps.size(), 2U);
}

TEST(GatherReport, TheChartsBeginWithTheCriterionThatAnsweredAndAllHaveTheOffsetFound) {
  const PreparedRecording prepared =
      prepare(test::simulated("room-1", 0.024, 4.5).recording, FeatureOptions(), Job()).value();
  const ReportContent content = gather_report(prepared, {}, nullptr, Job()).value();
  const std::vector<Chart> charts = evidence_charts(content);
  ASSERT_GE(charts.size(), 2U);
  EXPECT_TRUE(charts[0].title.starts_with("Distance between sweeps c [mm]: found 2")) << charts[0].title;
  EXPECT_TRUE(charts[1].title.starts_with("Motion between sweeps d [m]")) << charts[1].title;
  for (const Chart& chart : charts) {
    ASSERT_EQ(chart.verticals.size(), 1U) << chart.title;
    EXPECT_EQ(chart.verticals[0].x, *content.estimate.offset_s * 1e3) << chart.title;
    EXPECT_EQ(chart.verticals[0].label, charts[0].verticals[0].label);
  }
}

TEST(GatherReport, ARigThatIsSolvedForIsShownAndItsMapsAreThoseOfTheRigFound) {
  SimulationOptions tilted;
  tilted.scene = "room-2";
  tilted.offset_s = 0.024;
  tilted.duration_s = 4.5;
  tilted.mount_error_deg = {0, 3, -3};
  const Recording recording = simulate(tilted, Job()).value().recording;
  const PreparedRecording prepared = prepare(recording, FeatureOptions(), Job()).value();
  const ReportContent with_file = gather_report(prepared, {.live_points = 0}, nullptr, Job()).value();
  const ReportContent with_found =
      gather_report(prepared, {.solve = {.mount = true}, .live_points = 0}, nullptr, Job()).value();
  ASSERT_TRUE(with_found.estimate.rig);
  const auto thickness_m = [](const ReportContent& content) {
    return content.maps.at(1).thickness->map->median_m;
  };
  EXPECT_LT(thickness_m(with_found), 0.8 * thickness_m(with_file));
  const std::string html = report_html(with_found).value();
  for (const char* part :
       {"<h2>The rig</h2>", "mount pitch", "0.00°, kept", "With the rig file: ", "With the rig found: "})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(report_html(with_file).value().find("<h2>The rig</h2>"), std::string::npos);
}

TEST(GatherReport, OfAMotorWhoseOffsetIsAGaugeItShowsTheMapsOfTheRigs) {
  SimulationOptions made;
  made.scene = "room-2";
  made.motor = simulation::MotorKind::kOneWay;
  made.duration_s = 6;
  made.mount_error_deg = {0, 2, 1};
  const Simulation simulation = simulate(made, Job()).value();
  ReportOptions wanted;
  wanted.solve.mount = true;
  const auto prepared = prepare(simulation.recording, FeatureOptions(), Job()).value();
  const ReportContent content = gather_report(prepared, wanted, nullptr, Job()).value();
  ASSERT_EQ(content.maps.size(), 2U);
  EXPECT_LT(content.maps[1].thickness->map->median_m, 0.5 * content.maps[0].thickness->map->median_m);
  const std::string page = report_html(content).value();
  for (const char* words : {"rig as given", "rig as found", "does not blur the map", "turns, all one way"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_EQ(page.find("5 ms off"), std::string::npos);
}

TEST(ReportPage, AWarningOfTheRecordingThatTheEstimateRepeatsStandsOnce) {
  ReportContent content;
  content.recording.warnings = {"the motor is late"};
  content.estimate.warnings = {"the motor is late", "few matches"};
  const auto page = report_html(content);
  ASSERT_TRUE(page) << page.error().message;
  const std::size_t first = page->find("<li>the motor is late</li>");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(page->find("<li>the motor is late</li>", first + 1), std::string::npos);
  EXPECT_NE(page->find("<li>few matches</li>"), std::string::npos);
}

TEST(ReportPage, ABrokenMapIsWarnedOfAndSaidBesideTheThicknessOfItsSurfaces) {
  MapConsistency broken;
  broken.limit_m = 0.3;
  broken.apart = {{12, 31.5, 0.84, {1, 2, 0.5}}};
  broken.warnings = {"The map does not agree with itself"};
  ReportContent content;
  content.estimate.offset_s = 0.024;
  ComparedMap map;
  map.offset_s = 0.024;
  map.cloud = test::HallMap(0, 2'000).make();
  SurfaceThickness thickness;
  thickness.map.emplace();
  map.thickness = std::make_shared<const SurfaceThickness>(thickness);
  map.consistency = std::make_shared<const MapConsistency>(broken);
  content.maps = {map, map};
  const auto page = report_html(content);
  ASSERT_TRUE(page) << page.error().message;
  for (const char* part : {"<li>The map does not agree with itself</li>",
                           "surfaces seen twice lie at most 0.840 m apart (at 12 and 32 s)"})
    EXPECT_NE(page->find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace sweepscope
