#pragma once

#include <functional>

#include "core/error.hpp"
#include "core/simulation/meshes/ray_caster.hpp"

namespace sweepscope::simulation {

/// Minimum distance between a surface and the laser.
inline constexpr double kClearance_m = 0.15;

/// ExitCode::kWrongUsage, with time and position, if a laser at laser_at(t) comes nearer than kClearance_m to
/// a surface or passes through one; checked every 5 ms from 0 to duration_s.
Result<void> check_free_space(const RayCaster& scene, const std::function<Vector3d(double t_s)>& laser_at,
                              double duration_s);

}  // namespace sweepscope::simulation
