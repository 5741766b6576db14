#pragma once

#include <cstdint>

#include "core/geometry/map_cloud.hpp"
#include "core/simulation/math/portable_math.hpp"

namespace sweepscope::test {

/// The width at half height of a normal distribution, in standard deviations.
inline constexpr double kWidthPerDeviation = 2.3548;

/// A map made of patches whose noise is known. Points of even and odd sweeps take turns.
class NoisySurfaces {
 public:
  /// Points evenly over middle + u * along + v * up for u, v in [-1, 1], with noise across and sweeps of the
  /// two directions pushed apart by `shift_m` to either side.
  NoisySurfaces& patch(int points, const Eigen::Vector3d& middle, const Eigen::Vector3d& along,
                       const Eigen::Vector3d& up, double noise_m, double shift_m = 0) {
    const Eigen::Vector3d across = along.cross(up).normalized();
    for (int i = 0; i < points; ++i) {
      const double side = i % 2 == 0 ? 1 : -1;
      const Eigen::Vector3d p = middle + (2 * random_.uniform() - 1) * along +
                                (2 * random_.uniform() - 1) * up +
                                (noise_m * random_.normal() + side * shift_m) * across;
      add(p, i % 2 == 0 ? 0 : 1);
    }
    return *this;
  }
  void add(const Eigen::Vector3d& p_m, std::uint32_t sweep) {
    MapPoint point{};
    point.getVector3fMap() = p_m.cast<float>();
    point.sweep = sweep;
    point.time_s = 1e-4 * static_cast<double>(cloud.size());
    cloud.push_back(point);
  }
  simulation::Random& random() { return random_; }

  MapCloud cloud;

 private:
  simulation::Random random_{1, 7, 0};
};

}  // namespace sweepscope::test
