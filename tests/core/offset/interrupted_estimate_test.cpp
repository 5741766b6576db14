// Long work is interrupted at every point where it looks whether it is: the answer is the whole one, or none.
#include <fmt/format.h>

#include "core/map/offset_map.hpp"
#include "core/offset/estimator.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/results/estimate_json.hpp"
#include "tests/core/engine_fixtures.hpp"
#include "tests/core/every_look.hpp"

namespace sweepscope {
namespace {

using test::kMs;

const Recording& standing() {
  return test::simulated("room-1", 0.024, 2.5).recording;
}

const Recording& walking() {
  return test::simulated("metro-station", 0.024, 6).recording;
}

EstimateOptions directly() {
  EstimateOptions options;
  options.method = Method::kDirect;
  return options;
}

EstimateOptions over_candidates() {
  EstimateOptions options;
  options.ranges = {{22 * kMs, 26 * kMs, 1 * kMs}};
  return options;
}

void expect_whole_or_none(const Recording& recording, const EstimateOptions& options, std::uint64_t between) {
  test::expect_interrupted_at_every_look(between, [&](const Job& job) -> std::optional<std::string> {
    const Estimate found = estimate(recording, options, job).value();
    if (!found.interrupted) return estimate_to_json(found, Timing::kNull);
    EXPECT_FALSE(found.identifiable || found.offset_s || found.sigma_s || found.drift_ppm);
    EXPECT_TRUE(found.criteria.empty());
    EXPECT_EQ(found.reasons().size(), 1U);
    return std::nullopt;
  });
}

TEST(InterruptedEstimate, OfAStandingRigDirectly) {
  expect_whole_or_none(standing(), directly(), 20);
}

TEST(InterruptedEstimate, OfAStandingRigOverCandidates) {
  expect_whole_or_none(standing(), over_candidates(), 20);
}

TEST(InterruptedEstimate, OfAWalkDirectly) {
  expect_whole_or_none(walking(), directly(), 10);
}

TEST(InterruptedEstimate, OfAWalkOverCandidates) {
  expect_whole_or_none(walking(), over_candidates(), 10);
}

TEST(InterruptedWork, MapsOfAWalk) {
  constexpr double kOffsets_s[] = {0.019, 0.024};
  test::expect_interrupted_at_every_look(20, [&](const Job& job) -> std::optional<std::string> {
    const auto maps = build_maps(walking(), kOffsets_s, MapOptions(), job);
    if (!maps) {
      EXPECT_EQ(maps.error().code, ExitCode::kInterrupted);
      return std::nullopt;
    }
    std::string text;
    for (const OffsetMap& map : *maps) {
      text += fmt::format("{} {}\n", map.cloud->size(), map.lost);
      for (const StampedPose& pose : map.trajectory)
        text += fmt::format("{} {} {}\n", pose.position_m.x(), pose.position_m.y(), pose.position_m.z());
    }
    return text;
  });
}

TEST(InterruptedWork, Preparing) {
  test::expect_interrupted_at_every_look(100, [&](const Job& job) -> std::optional<std::string> {
    const auto found = prepare(standing(), FeatureOptions(), job);
    if (found)
      return fmt::format("{} {}", found->features->edges.features.size(),
                         found->features->planes.features.size());
    EXPECT_EQ(found.error().code, ExitCode::kInterrupted);
    return std::nullopt;
  });
}

}  // namespace
}  // namespace sweepscope
