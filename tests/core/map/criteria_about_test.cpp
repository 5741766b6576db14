#include "core/map/criteria_about.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

// The candidates beside maps at these offsets, in milliseconds.
std::vector<long> candidates_ms(const std::vector<double>& offsets_s) {
  const test::Bench bench;
  const Recording recording = bench.record();
  const PreparedRecording prepared = prepare(recording, FeatureOptions(), Job()).value();
  std::vector<OffsetMap> maps;
  for (const double offset_s : offsets_s) maps.emplace_back().offset_s = offset_s;
  std::vector<long> found_ms;
  const Estimate criteria = criteria_about(prepared, maps, {}, Job()).value();
  for (const CurvePoint& point : criteria.curve) found_ms.push_back(std::lround(point.offset_s * 1e3));
  return found_ms;
}

TEST(CriteriaAboutMaps, AreOfElevenCandidatesIfTheOffsetsAreNearAndReachBeyondThem) {
  EXPECT_EQ(candidates_ms({24 * kMs, 24 * kMs}),
            (std::vector<long>{19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29}));
  EXPECT_EQ(candidates_ms({24 * kMs, 19 * kMs}), (std::vector<long>{17, 18, 19, 20, 21, 22, 23, 24, 25, 26}));
  const auto wide_ms = candidates_ms({10 * kMs, 20 * kMs, 30 * kMs});
  EXPECT_EQ(wide_ms.front(), 8);
  EXPECT_EQ(wide_ms.back(), 32);
}

}  // namespace
}  // namespace sweepscope
