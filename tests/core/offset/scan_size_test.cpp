#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/map/offset_map.hpp"
#include "core/numbers.hpp"
#include "core/offset/estimator.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/stationary/stationary_points.hpp"

namespace sweepscope {
namespace {

/// A rig in a round room with a wavy wall, turned to and fro once in 2 s.
Recording recording_of(const std::vector<std::uint32_t>& beams_of_scans, double field_rad) {
  Recording recording;
  recording.name = "made";
  for (std::size_t i = 0; i < beams_of_scans.size(); ++i) {
    LaserScan scan;
    scan.first_beam_s = 0.1 * static_cast<double>(i);
    scan.beams = beams_of_scans[i];
    scan.angle_min_rad = -field_rad / 2;
    scan.angle_increment_rad = field_rad / scan.beams;
    scan.time_increment_s = 0.09 / scan.beams;
    scan.first_range = recording.ranges_m.size();
    for (std::uint32_t beam = 0; beam < scan.beams; ++beam)
      recording.ranges_m.push_back(static_cast<float>(3 + 0.5 * std::sin(3 * scan.beam_angle_rad(beam))));
    recording.scans.push_back(scan);
  }
  for (double t_s = -0.3; t_s < 0.1 * static_cast<double>(beams_of_scans.size()) + 0.3; t_s += 0.01) {
    const double phase = std::fmod(t_s + 2, 2.0);
    recording.motor.time_s.push_back(t_s);
    recording.motor.angle_rad.push_back(phase < 1 ? -1 + 2 * phase : 3 - 2 * phase);
  }
  recording.report.laser_stamps.median_period_s = 0.1;
  recording.report.motor_stamps.median_period_s = 0.01;
  return recording;
}

/// Every way through the engine; none may crash.
void expect_ends(const Recording& recording) {
  for (const RigKind kind : {RigKind::kStationary, RigKind::kMoving}) {
    EstimateOptions options;
    options.method = Method::kDirect;
    options.assume = kind;
    const auto found = estimate(recording, options, Job());
    ASSERT_TRUE(found) << found.error().message;
    MapOptions map;
    map.assume = kind;
    const double offset_s = 0.003;
    const auto maps = build_maps(recording, {&offset_s, 1}, map, Job());
    ASSERT_TRUE(maps) << maps.error().message;
  }
  test_motion(prepare(recording, FeatureOptions(), Job()).value());  // ends
}

TEST(ScanSize, TheMostBeamsAScanAreWorkedWith) {
  expect_ends(recording_of(std::vector<std::uint32_t>(30, kMaxBeamsAScan), 1.5 * std::numbers::pi));
}

TEST(ScanSize, AFieldOfViewBeyondAFullTurnIsWorkedWith) {
  expect_ends(recording_of(std::vector<std::uint32_t>(45, 1600), 400 * kRadPerDeg));
  expect_ends(recording_of(std::vector<std::uint32_t>(45, 1600), 40'000 * kRadPerDeg));
}

TEST(ScanSize, AFewLongScansAmongShortOnesTakeNoRoomInAllOfThem) {
  std::vector<std::uint32_t> beams(300, 12);
  beams[7] = kMaxBeamsAScan;
  const Recording recording = recording_of(beams, 3);
  const OffsetProblem problem = problem_for(prepare(recording, FeatureOptions(), Job()).value(), 0, 0);
  const StationaryGrid grid = stationary_grid(problem);
  EXPECT_LT(grid.feature.size(), 16 * recording.ranges_m.size());
  EXPECT_LT(grid.bins, 1000U);
  expect_ends(recording);
}

}  // namespace
}  // namespace sweepscope
