#include "core/offset/prepared/prepared.hpp"

#include <gtest/gtest.h>

#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

double matched_part(double sweep_s) {
  const auto prepared = prepare(test::simulated("room-1", 0, 2.5, sweep_s).recording, {}, Job()).value();
  const std::vector<Feature>& planes = prepared.features->planes.features;
  return double(std::ranges::count(planes, true, &Feature::sharp)) / double(planes.size());
}

TEST(Prepared, SweepsOfFewBeamsMatchMoreOfTheirPlanePoints) {
  EXPECT_NEAR(matched_part(0.5), 1.0 / 3, 0.02);
  EXPECT_NEAR(matched_part(0.3), 1.0 / 2, 0.02);
  EXPECT_EQ(matched_part(0.2), 1);
}

TEST(Prepared, TheFeaturesThemselvesDoNotDependOnHowManyAreMatched) {
  const Recording& recording = test::simulated("room-1", 0, 2.5, 0.2).recording;
  const auto prepared = prepare(recording, {}, Job()).value();
  const FeatureSet sparse = extract_features(recording, {}, Job()).value();
  EXPECT_TRUE(std::ranges::equal(prepared.features->planes.features, sparse.planes.features, {},
                                 &Feature::beam, &Feature::beam));
}

}  // namespace
}  // namespace sweepscope
