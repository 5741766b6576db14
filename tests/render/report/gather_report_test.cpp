#include "render/report/gather_report.hpp"

#include "tests/core/engine_fixtures.hpp"
#include "tests/core/every_look.hpp"

namespace sweepscope {
namespace {

TEST(GatherReport, InterruptedAtAnyLookItGivesNothing) {
  const Recording& recording = test::simulated("room-1", 0.024, 2.5).recording;
  test::expect_interrupted_at_every_look(5, [&](const Job& job) -> std::optional<std::string> {
    const auto content = gather_report(recording, std::nullopt, nullptr, job);
    if (content) return report_html(*content).value();
    EXPECT_EQ(content.error().code, ExitCode::kInterrupted);
    return std::nullopt;
  });
}

}  // namespace
}  // namespace sweepscope
