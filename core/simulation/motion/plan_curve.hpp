#pragma once

#include <vector>

#include "core/simulation/meshes/mesh.hpp"

namespace sweepscope::simulation {

/// A smooth curve in plan (a cubic spline, twice continuously differentiable) over the distance along it.
class PlanCurve {
 public:
  PlanCurve(const std::vector<Vector2d>& waypoints_m, bool closed);

  struct Point {
    Vector2d position_m;
    Vector2d forward;        // unit length
    double curvature_per_m;  // > 0 turns left
  };

  double length_m() const { return distance_m_.back(); }
  Point at(double distance_m) const;

 private:
  struct Span {
    Vector2d c0, c1, c2, c3;  // c0 + c1 u + c2 u^2 + c3 u^3, u in [0, 1]
  };
  Point on_spline(double u) const;

  std::vector<Span> spans_;
  std::vector<double> distance_m_,
      per_unit_m_;  // distance and its slope over u, at every 1 / kParts of a span
};

}  // namespace sweepscope::simulation
