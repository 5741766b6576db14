#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/map/offset_map.hpp"
#include "core/map/sections/cross_section.hpp"
#include "core/map/sections/section_points.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "core/numbers.hpp"
#include "tests/core/engine_fixtures.hpp"

// The thickness of the simulated metro station's surfaces beside the profile tool, which measures one box.
namespace sweepscope {
namespace {

struct Place {
  const char* name;
  CrossSection section;
};

CrossSection section_at(double x_m, double y_m, double normal_deg, double length_m, double from_m,
                        double to_m) {
  CrossSection section;
  section.at_m = {x_m, y_m};
  section.normal_rad = normal_deg * kRadPerDeg;
  section.length_m = length_m;
  section.from_m = from_m;
  section.to_m = to_m;
  return section;
}

// A face of the hexagonal pillar, 0.45 m wide, and the side walls, 48 m long. The boxes are low: a wrong
// offset moves points in proportion to their height.
std::vector<Place> places() {
  const double face_m = 0.45 * std::cos(30 * kRadPerDeg), angle_rad = 210 * kRadPerDeg;
  const double x_m = face_m * std::cos(angle_rad), y_m = face_m * std::sin(angle_rad);
  return {{"pillar, 3.0 to 3.6 m high", section_at(x_m, y_m, 210, 0.4, 3.0, 3.6)},
          {"pillar, 3.6 to 4.2 m high", section_at(x_m, y_m, 210, 0.4, 3.6, 4.2)},
          {"long wall, 3.7 to 4.1 m high", section_at(0, 12, 90, 2, 3.7, 4.1)}};
}

// The median over the points in the box whose surface lies as the section's face.
double thickness_in_mm(const CrossSection& section, const MapCloud& cloud,
                       const std::vector<LocalSurface>& surfaces) {
  std::vector<double> thickness_mm;
  const auto inside = points_inside(cloud, points_near(cloud, {&section, 1}).front(), section);
  for (const std::uint32_t i : inside) {
    const bool along_face = std::abs(surfaces[i].normal.dot(section.across().cast<float>())) > 0.9F;
    if (surfaces[i].kind == SurfaceKind::kFlat && along_face)
      thickness_mm.push_back(double(surfaces[i].thickness_m) * 1e3);
  }
  EXPECT_GT(double(thickness_mm.size()), 0.5 * double(inside.size()));
  return median(std::move(thickness_mm));
}

TEST(MetroThickness, IsWithinAFifthOfTheProfileTool) {
  SimulationOptions simulated;
  simulated.scene = "metro-station";
  simulated.offset_s = 0.024;
  const Simulation simulation = simulate(simulated, Job()).value();
  MapOptions options;
  for (const TruthPose& pose : simulation.truth)
    options.poses.push_back({pose.time_s, pose.position_m, pose.orientation});
  for (const double offset_ms : {19.0, 22.0, 24.0}) {
    const std::vector<double> offsets_s{offset_ms * 1e-3};
    const auto maps = build_maps(simulation.recording, offsets_s, options, Job()).value();
    const MapCloud& cloud = *maps.front().cloud;
    const SurfaceThickness found = surface_thickness(cloud);
    ASSERT_TRUE(found.map);
    fmt::print("{} ms: {}\n", offset_ms, in_words(*found.map));
    for (const Place& place : places()) {
      const double profile_mm = profile_across(cloud, place.section).width_at_half_height_mm.value();
      const double thickness_mm = thickness_in_mm(place.section, cloud, found.surfaces);
      fmt::print("  {:<30} thickness {:4.0f} mm   profile {:4.0f} mm\n", place.name, thickness_mm,
                 profile_mm);
      EXPECT_NEAR(thickness_mm, profile_mm, 0.2 * profile_mm) << place.name << " at " << offset_ms;
    }
  }
}

}  // namespace
}  // namespace sweepscope
