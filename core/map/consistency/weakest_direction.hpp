#pragma once

// The mathematics: docs/algorithms.md, section 19.

#include <Eigen/Core>
#include <vector>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {

/// The direction of translation that matches determine least, once the rotation is free.
struct WeakestDirection {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // unit, in the frame of the matches
  /// How many matches face it, within 60 deg: the sum of their weights times the squares of the cosines.
  double facing = 0;
};

/// Matches of one rigid move, by their surfaces' normals.
class FacedSurfaces {
 public:
  /// A match at `arm_m` from the centre of rotation whose point lies `distance_m` from its surface along
  /// `normal` (unit). Its weight falls from 1 with the distance, as in a Cauchy loss of 0.05 m.
  void add(const Eigen::Vector3d& arm_m, const Eigen::Vector3d& normal, double distance_m);
  /// Without matches, any direction, which none faces.
  WeakestDirection weakest() const;

 private:
  struct Face {
    Eigen::Vector3d normal;
    double weight;
  };
  RigidEquations equations_;
  std::vector<Face> faces_;
};

}  // namespace sweepscope
