#include "core/map/turnable_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/map/offset_map.hpp"
#include "core/offset/walk/walk.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

// By how much the points of a map are apart from those of the program's own map at the same offset; they are
// told by their times. Fails where a beam is in one of them alone.
double greatest_distance_m(const TurnableMap& map, const MapCloud& reference, double offset_s) {
  std::map<double, const MapPoint*> by_time;
  for (const MapPoint& point : reference) by_time[point.time_s] = &point;
  const auto positions_m = positions_at(map, offset_s);
  double greatest_m = 0;
  std::size_t placed = 0;
  for (std::size_t i = 0; i < positions_m.size(); ++i) {
    const auto found = by_time.find(map.beams[i].time_s);
    EXPECT_EQ(std::isnan(positions_m[i][0]), found == by_time.end()) << map.beams[i].time_s;
    if (found == by_time.end() || std::isnan(positions_m[i][0])) continue;
    ++placed;
    const Eigen::Vector3f p_m(positions_m[i][0], positions_m[i][1], positions_m[i][2]);
    greatest_m = std::max(greatest_m, double((p_m - found->second->getVector3fMap()).norm()));
  }
  EXPECT_GT(placed, positions_m.size() * 9 / 10);
  return greatest_m;
}

TEST(TurnableMap, OfAStationaryRigIsTheProgramsMapAtEveryOffset) {
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  const TurnableMap map = turnable_map(prepared, nullptr, 10 * kMs, 40 * kMs);
  EXPECT_EQ(map.beams.size(), map.usable_beams);
  for (const double offset_s : {10 * kMs, 24 * kMs, 40 * kMs}) {
    const std::vector<double> all{10 * kMs, offset_s, 40 * kMs};  // from the same scans
    const auto maps = build_maps(prepared, all, {}, Job()).value();
    EXPECT_LT(greatest_distance_m(map, *maps[1].cloud, offset_s), 1e-5) << offset_s;
  }
}

TEST(TurnableMap, OfAWalkIsTheProgramsMapAlongTheSameTrajectory) {
  const Simulation& walk = test::simulated("metro-station", 24 * kMs, 8);
  const PreparedRecording prepared = prepare(walk.recording, FeatureOptions(), Job()).value();
  MapOptions options;
  options.assume = RigKind::kMoving;
  const std::vector<double> offsets_s{19 * kMs, 22 * kMs, 24 * kMs};
  const auto maps = build_maps(prepared, offsets_s, options, Job()).value();
  const TurnableMap map = turnable_map(prepared, &maps[0].walk->sweeps, 19 * kMs, 24 * kMs);
  for (std::size_t i = 0; i < maps.size(); ++i)
    EXPECT_LT(greatest_distance_m(map, *maps[i].cloud, offsets_s[i]), 1e-5) << offsets_s[i];
}

TEST(TurnableMap, WithFewerBeamsPlacesThemWhereTheyWere) {
  const PreparedRecording prepared = prepare(test::room(24 * kMs), FeatureOptions(), Job()).value();
  const TurnableMap map = turnable_map(prepared, nullptr, 19 * kMs, 24 * kMs);
  const auto all_m = positions_at(map, 19 * kMs);
  const auto kept = evenly_in_space(all_m, 5000);
  EXPECT_EQ(kept.size(), 5000u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  const TurnableMap fewer = with_beams(map, kept);
  const auto few_m = positions_at(fewer, 19 * kMs);
  ASSERT_EQ(few_m.size(), kept.size());
  EXPECT_EQ(fewer.usable_beams, map.usable_beams);
  for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(few_m[i], all_m[kept[i]]);
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
