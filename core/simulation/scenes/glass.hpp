#pragma once

#include <cstdint>
#include <optional>

#include "core/simulation/meshes/ray_caster.hpp"

namespace sweepscope::simulation {

/// Panes of glass: the parts of upright surfaces that lie in a random selection of the cells of a 1 m grid. A
/// beam passes a pane with probability 0.9; otherwise it is mirrored away and nothing returns.
class Glass {
 public:
  /// `part` of the cells, 0 to 1.
  Glass(double part, std::uint64_t seed) : part_(part), seed_(seed) {}

  /// The end of a beam that panes let through or deflect.
  struct End {
    std::optional<Hit> hit;
    double range_m = 0;  // how far the beam comes
  };
  /// `beam` identifies a beam of the recording.
  End cast(const RayCaster& scene, const Vector3d& origin, const Vector3d& direction, double max_range_m,
           std::uint64_t beam) const;

 private:
  bool covers(const Vector3d& point_m, const Vector3d& normal) const;

  double part_;
  std::uint64_t seed_;
};

}  // namespace sweepscope::simulation
