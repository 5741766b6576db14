#include "render/report/gather_report.hpp"

#include "tests/core/engine_fixtures.hpp"
#include "tests/core/every_look.hpp"

namespace sweepscope {
namespace {

TEST(GatherReport, InterruptedAtAnyLookItGivesNothing) {
  const PreparedRecording prepared =
      prepare(test::simulated("room-1", 0.024, 2.5).recording, FeatureOptions(), Job()).value();
  test::expect_interrupted_at_every_look(5, [&](const Job& job) -> std::optional<std::string> {
    const auto content = gather_report(prepared, {}, nullptr, job);
    if (content) return report_html(*content).value();
    EXPECT_EQ(content.error().code, ExitCode::kInterrupted);
    return std::nullopt;
  });
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

}  // namespace
}  // namespace sweepscope
