#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/simulation/meshes/mesh.hpp"
#include "core/simulation/worlds/draw.hpp"

/// What several worlds are furnished with.
namespace sweepscope::simulation {

using Box2 = Eigen::AlignedBox2d;

/// Places for things on the ground, at least `gap_m` between one and the next.
class Spots {
 public:
  explicit Spots(double gap_m) : gap_m_(gap_m) {}
  /// Marks a place as taken, whatever is there.
  void take(const Vector2d& at_m, double radius_m) { taken_.emplace_back(at_m, radius_m); }
  /// A random free place in the box; none where a few dozen tries find none.
  std::optional<Vector2d> find(Draw& draw, const Box2& within_m, double radius_m);

 private:
  double gap_m_;
  std::vector<std::pair<Vector2d, double>> taken_;
};

/// Gently undulating ground.
class Relief {
 public:
  /// Heights within +-height_m; hills at least wave_m long.
  Relief(Draw& draw, double height_m, double wave_m);
  double at(const Vector2d& p_m) const;
  /// The ground in a box, of squares of at most 1 m.
  Mesh mesh(const Box2& box_m, double albedo) const;

 private:
  struct Wave {
    Vector2d per_m;
    double phase_rad, height_m;
  };
  std::vector<Wave> waves_;
};

/// Things made by `make` at up to `count` free spots in a box, each on the ground and turned at random.
void scatter(Mesh& mesh, Draw& draw, Spots& spots, const Relief& relief, const Box2& within_m, int count,
             double radius_m, const std::function<Mesh()>& make);

/// The places of four walls around a box, each seen from inside (its front at local y = 0, seen from y < 0),
/// with their lengths: north, east, south, west.
std::vector<std::pair<Placement, double>> sides_of(const Box2& box_m);

/// Walls of a room with doors, niches, boards, pilasters, radiators and cabinets at random, none of which
/// stands out by more than depth_m. Along +x, its front at y = 0, seen from y < 0.
Mesh furnished_wall(Draw& draw, double length_m, double height_m, double depth_m);

/// A shed of 2 to 6 m with a pitched roof, its middle at the origin.
Mesh shed(Draw& draw);
/// Crates on one another, within 0.9 m of the origin.
Mesh crates(Draw& draw);
/// A pole, sign, bollard, lamp or bin, within 0.4 m of the origin but for a lamp's arm.
Mesh pole(Draw& draw);
/// A tree of any kind.
Mesh any_tree(Draw& draw, double max_height_m);

}  // namespace sweepscope::simulation
