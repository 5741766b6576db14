#pragma once

#include <cstdint>

#include "core/simulation/meshes/mesh.hpp"

/// Parts that several outdoor scenes share. Each stands on z = 0.
namespace sweepscope::simulation {

struct FacadeSpec {
  double length_m = 20;
  int floors = 3;
  int bays = 6;  // windows per floor
  double floor_m = 3.2;
  int door_bay = -1;  // the bay with a door on the ground floor; none below 0
};
/// A building's front along +x at y = 0, seen from y < 0: plinth, windows in recesses, sills, cornices. The
/// building is 1 m deep behind it.
Mesh facade(const FacadeSpec& spec);

/// A trunk at the origin, branches, and a crown of several boulders; different for every seed.
Mesh tree(double height_m, double crown_m, std::uint64_t seed);

/// A bare tree of trunk and forked branches.
Mesh bare_tree(double height_m, std::uint64_t seed);

/// A mast at the origin with an arm along +x.
Mesh lamp_post(double height_m);

/// Forward is +x, the middle of the wheelbase over the origin. `tall` makes a van of it.
Mesh car(bool tall, double albedo);

/// A bench facing -y, its front left corner at the origin.
Mesh garden_bench();

}  // namespace sweepscope::simulation
