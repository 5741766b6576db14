#include "core/map/replace_points.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>

#include "core/map/offset_map.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "tests/core/engine_fixtures.hpp"

namespace sweepscope {
namespace {

using test::kMs;

constexpr double kOffset_s = 0.024;
using Places = std::vector<std::array<float, 3>>;

struct Solved {
  explicit Solved(const Recording& recording, RigKind assumed) : beams(collect_beams(recording)) {
    MapOptions options;
    options.assume = assumed;
    const std::array offsets_s{kOffset_s};
    map = build_maps(recording, offsets_s, options, Job()).value().front();
    path = fix_path(recording, map.sweeps, scans_covered(recording, kOffset_s, kOffset_s));
  }
  Places at(double offset_s) const {
    Places places(beams.size());
    replace_points(beams, path, offset_s, places);
    return places;
  }
  Beams beams;
  OffsetMap map;
  FixedPath path;
};

const Solved& walk() {
  static const Solved solved(test::simulated("metro-station", kOffset_s, 6).recording, RigKind::kMoving);
  return solved;
}

const Solved& standing() {
  static const Solved solved(test::room(kOffset_s), RigKind::kStationary);
  return solved;
}

double distance_m(const std::array<float, 3>& a, const MapPoint& b) {
  return static_cast<double>(std::hypot(a[0] - b.x, a[1] - b.y, a[2] - b.z));
}

TEST(ReplacePoints, AtTheOffsetThatThePathWasSolvedForItIsTheMap) {
  for (const Solved* solved : {&walk(), &standing()}) {
    const Places places = solved->at(kOffset_s);
    std::size_t next = 0, compared = 0;
    double worst_m = 0;
    for (const MapPoint& point : *solved->map.cloud) {
      while (next < places.size() && solved->beams.time_s(next) < point.time_s - 1e-9) ++next;
      ASSERT_LT(next, places.size());
      if (std::isnan(places[next][0])) continue;
      worst_m = std::max(worst_m, distance_m(places[next], point));
      ++compared;
    }
    EXPECT_LT(worst_m, 2e-4);
    EXPECT_GT(static_cast<double>(compared), 0.95 * static_cast<double>(solved->map.cloud->size()));
  }
}

TEST(ReplacePoints, AnotherOffsetTurnsABeamAboutTheMotorsAxisByItsSpeed) {
  const Recording& recording = test::room(kOffset_s);
  const Beams beams = collect_beams(recording);
  const FixedPath path = standing_path(recording, scans_covered(recording, 0.02, 0.03));
  Places before(beams.size()), after(beams.size());
  replace_points(beams, path, kOffset_s, before);
  replace_points(beams, path, kOffset_s + 2 * kMs, after);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < beams.size(); i += 997) {
    if (std::isnan(before[i][0])) continue;
    ++compared;
    const double t_s = beams.time_s(i) + kOffset_s;
    const double turn_rad = recording.motor.angle_at(t_s + 2 * kMs) - recording.motor.angle_at(t_s);
    const Eigen::Vector2d p(before[i][1], before[i][2]);
    const Eigen::Vector2d q = Eigen::Rotation2Dd(turn_rad) * p;
    EXPECT_NEAR(q.x(), after[i][1], 1e-5);
    EXPECT_NEAR(q.y(), after[i][2], 1e-5);
    EXPECT_NEAR(before[i][0], after[i][0], 1e-6);
  }
  EXPECT_GT(compared, 50U);
}

TEST(ReplacePoints, ChosenBeamsAreWhereAllOfThemPutThem) {
  const Places all = walk().at(0.021);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 5; i < all.size(); i += 31) chosen.push_back(i);
  Places some(chosen.size());
  replace_points(walk().beams, walk().path, 0.021, chosen, some);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    if (std::isnan(some[k][0]))
      EXPECT_TRUE(std::isnan(all[chosen[k]][0]));
    else
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(some[k][axis], all[chosen[k]][axis], 1e-5);
  }
}

TEST(ReplacePoints, OneThreadGivesTheSameBytesAsMany) {
  const Places many = walk().at(0.02);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Places single = walk().at(0.02);
  EXPECT_EQ(std::memcmp(many.data(), single.data(), many.size() * sizeof many[0]), 0);
}

TEST(ReplacePoints, ABeamNamesItsScanAndRange) {
  const Recording& recording = test::room(kOffset_s);
  const Beams beams = collect_beams(recording);
  const std::size_t point = beams.size() / 2, scan = beams.scan[point];
  EXPECT_LE(beams.first_point[scan], point);
  EXPECT_GT(beams.first_point[scan + 1], point);
  EXPECT_EQ(beams.range_m(point), recording.ranges(recording.scans[scan])[beams.beam[point]]);
  const auto& p = beams.p_in_motor_m[point];
  EXPECT_NEAR(std::hypot(p[0], p[1], p[2]), beams.range_m(point), 1e-5);
}

}  // namespace
}  // namespace sweepscope
