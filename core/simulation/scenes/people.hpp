#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/simulation/meshes/ray_caster.hpp"

namespace sweepscope::simulation {

/// A person who walks in a circle: an upright cylinder, 0.5 m wide and 1.75 m high.
struct Person {
  static constexpr double kRadius_m = 0.25, kHeight_m = 1.75, kSpeed_mps = 1;

  Vector2d middle_m = Vector2d::Zero();  // of the circle
  double circle_m = 1;                   // its radius
  double phase_rad = 0;
  bool clockwise = false;
  double floor_m = 0;  // the feet's height

  Vector2d at(double t_s) const;
  /// The range at which a beam of unit direction meets the body's side or its top.
  std::optional<Hit> cast(const Vector3d& origin, const Vector3d& direction, double t_s) const;
};

/// `count` people around a rig that is at rig_at(t) for duration_s. Their circles keep 0.3 m from the scene's
/// surfaces from knee to chest, and they keep 0.5 m from the rig. They may walk through each other.
/// ExitCode::kWrongUsage if the scene has no room for them.
Result<std::vector<Person>> place_people(int count, std::uint64_t seed, const RayCaster& scene,
                                         const std::function<Vector3d(double t_s)>& rig_at,
                                         double duration_s);

}  // namespace sweepscope::simulation
