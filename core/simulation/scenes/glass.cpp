#include "core/simulation/scenes/glass.hpp"

#include <cmath>

#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::simulation {
namespace {

enum GlassPurpose : std::uint64_t { kPane = 9, kBeam = 10 };

constexpr double kPasses = 0.9;
constexpr double kBehind_m = 1e-4;  // where a beam goes on behind a pane

}  // namespace

bool Glass::covers(const Vector3d& point_m, const Vector3d& normal) const {
  if (std::abs(normal.z()) > 0.5) return false;
  // Off the whole metres, where walls stand: rounding must not choose the side of a cell's border.
  const Vector3d off_m(0.3183, 0.2718, 0.1414);
  std::uint64_t number = 0;
  for (int i = 0; i < 3; ++i) {
    const auto cell = static_cast<std::int64_t>(std::floor(point_m[i] + off_m[i]));
    number = (number << 21) | (static_cast<std::uint64_t>(cell) & 0x1fffff);
  }
  return Random(seed_, kPane, number).uniform() < part_;
}

Glass::End Glass::cast(const RayCaster& scene, const Vector3d& origin, const Vector3d& direction,
                       double max_range_m, std::uint64_t beam) const {
  Random random(seed_, kBeam, beam);
  double passed_m = 0;
  while (true) {
    auto hit = scene.cast(origin + passed_m * direction, direction, max_range_m - passed_m);
    if (!hit) return {std::nullopt, max_range_m};
    hit->range_m += passed_m;
    if (part_ == 0 || !covers(origin + hit->range_m * direction, hit->normal)) return {hit, hit->range_m};
    if (random.uniform() >= kPasses) return {std::nullopt, hit->range_m};
    passed_m = hit->range_m + kBehind_m;
    if (passed_m >= max_range_m) return {std::nullopt, max_range_m};
  }
}

}  // namespace sweepscope::simulation
