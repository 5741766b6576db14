#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "core/simulation/mesh.hpp"

namespace sweepscope::simulation {

/// Where a beam meets a surface.
struct Hit {
  double range_m = 0;
  double cos_incidence = 1;  // 1 where it meets the surface squarely, 0 where it grazes it
  double albedo = 0.5;
  Vector3d normal = Vector3d::UnitZ();  // unit length, to either side
};

/// Finds the first triangle along a beam. Embree's tree, in single precision, only proposes triangles, from
/// boxes drawn a little too large; each is then met in double precision, so the answer does not depend on
/// which instructions the processor offers. Of two triangles at the same range the earlier in the mesh wins.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// `direction` has unit length. Nothing within max_range_m is no hit. Safe to call from many threads.
  std::optional<Hit> cast(const Vector3d& origin, const Vector3d& direction, double max_range_m) const;

  /// How far the nearest surface is from a point; none where that is more than within_m.
  std::optional<double> distance_m(const Vector3d& point_m, double within_m) const;
  /// The box around all surfaces.
  Eigen::AlignedBox3d bounds_m() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sweepscope::simulation
