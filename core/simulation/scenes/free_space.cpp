#include "core/simulation/scenes/free_space.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sweepscope::simulation {
namespace {

std::string place(double t_s, const Vector3d& p_m) {
  return fmt::format("{:.2f} s after its start the rig, at ({:.2f}, {:.2f}, {:.2f}) m,", t_s, p_m.x(),
                     p_m.y(), p_m.z());
}

bool is_blocked(const RayCaster& scene, const Vector3d& from, const Vector3d& to) {
  const double length_m = (to - from).norm();
  return length_m > 0 && scene.cast(from, (to - from) / length_m, length_m);
}

}  // namespace

Result<void> check_free_space(const RayCaster& scene, const std::function<Vector3d(double t_s)>& laser_at,
                              double duration_s) {
  constexpr double kStep_s = 0.005;
  constexpr const char* kRemedy = "; move the walk, turn it or scale it down";
  const auto steps = static_cast<int>(std::floor(duration_s / kStep_s + 1e-9));
  Vector3d before = laser_at(0);
  for (int i = 0; i <= steps; ++i) {
    const Vector3d now = laser_at(i * kStep_s);
    if (const auto near_m = scene.distance_m(now, kClearance_m))
      return failure(ExitCode::kWrongUsage,
                     fmt::format("{} is {:.3f} m from a surface, nearer than {:g} m{}",
                                 place(i * kStep_s, now), *near_m, kClearance_m, kRemedy));
    if (is_blocked(scene, before, now))
      return failure(ExitCode::kWrongUsage,
                     fmt::format("{} has passed through a surface{}", place(i * kStep_s, now), kRemedy));
    before = now;
  }
  return {};
}

}  // namespace sweepscope::simulation
