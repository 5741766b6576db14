#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "core/simulation/meshes/mesh.hpp"

namespace sweepscope::simulation {

/// The point at which a beam meets a surface.
struct Hit {
  double range_m = 0;
  double cos_incidence = 1;  // 1 where it meets the surface squarely, 0 where it grazes it
  double albedo = 0.5;
  Vector3d normal = Vector3d::UnitZ();  // unit length, to either side
};

/// Finds the first triangle along a beam. Embree's tree, in single precision, only proposes triangles, from
/// slightly enlarged boxes; each is then intersected in double precision, so that the result does not depend
/// on the processor. Of two triangles at the same range, the earlier one in the mesh is returned.
class RayCaster {
 public:
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// `direction` has unit length. No hit if there is nothing within max_range_m. Thread-safe.
  std::optional<Hit> cast(const Vector3d& origin, const Vector3d& direction, double max_range_m) const;

  /// The distance of the nearest surface from a point; absent if it is more than within_m.
  std::optional<double> distance_m(const Vector3d& point_m, double within_m) const;
  /// The box around all surfaces.
  Eigen::AlignedBox3d bounds_m() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace sweepscope::simulation
