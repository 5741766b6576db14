#include "core/map/turnable_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/map/place_beams.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

TEST(TurnableMap, HoldsTheChosenBeamsInTheirScans) {
  const Recording& recording = test::room(24 * test::kMs);
  const PreparedRecording prepared = prepare(recording, FeatureOptions(), Job()).value();
  const Beams beams = collect_beams(recording);
  const MapPath path = path_without_solving(prepared, scans_covered(recording, 0.01, 0.04));
  const auto chosen = evenly_in_space(place_beams(beams, path, 0.019), 5000);
  EXPECT_EQ(chosen.size(), 5000u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  const TurnableMap map = turnable_map(beams, path, chosen);
  EXPECT_FALSE(map.moving);
  ASSERT_EQ(map.beams.size(), chosen.size());
  std::size_t k = 0;
  for (const TurnableScan& scan : map.scans)
    for (std::size_t i = 0; i < scan.beams; ++i, ++k) {
      const LaserScan& own = recording.scans[beams.scan[chosen[k]]];
      ASSERT_EQ(scan.middle_s, (own.first_beam_s + own.last_beam_s()) / 2);
      ASSERT_EQ(map.beams[k].time_s, beams.time_s(chosen[k]));
      const auto& p_m = map.beams[k].p_in_motor_m;
      ASSERT_NEAR(std::hypot(p_m[0], p_m[1], p_m[2]), beams.range_m(chosen[k]), 1e-5);
    }
  EXPECT_EQ(k, chosen.size());
}

TEST(EvenlyInSpace, KeepsMoreOfWhatIsSpreadThanOfWhatIsDense) {
  simulation::Random random(1, 2, 3);
  std::vector<std::array<float, 3>> points_m;
  for (int i = 0; i < 20000; ++i) {  // a dense square on one side, a blurred one on the other
    const float x_m = float(random.uniform()), y_m = float(random.uniform());
    points_m.push_back(i % 2 == 0 ? std::array{x_m, y_m, 0.F}
                                  : std::array{x_m + 5, y_m, 0.3F * float(random.uniform())});
  }
  const auto kept = evenly_in_space(points_m, 3000);
  ASSERT_EQ(kept.size(), 3000u);
  const auto blurred = std::count_if(kept.begin(), kept.end(), [](std::uint32_t i) { return i % 2 == 1; });
  EXPECT_GT(blurred, 1900);
}

TEST(EvenlyInSpace, LeavesOutWhatIsNowhereAndKeepsAllWhereThereIsRoom) {
  const float nan = std::nanf("");
  const std::vector<std::array<float, 3>> points_m{{0, 0, 0}, {nan, nan, nan}, {0, 0, 0}, {1, 2, 3}};
  EXPECT_EQ(evenly_in_space(points_m, 10), (std::vector<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(evenly_in_space(points_m, 2), (std::vector<std::uint32_t>{0, 3}));
  EXPECT_TRUE(evenly_in_space(points_m, 0).empty());
  EXPECT_TRUE(evenly_in_space({}, 5).empty());
}

}  // namespace
}  // namespace sweepscope
