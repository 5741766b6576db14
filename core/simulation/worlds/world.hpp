#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/simulation/meshes/mesh.hpp"
#include "core/simulation/worlds/draw.hpp"

namespace sweepscope::simulation {

/// A place whose layout, sizes and clutter are drawn at random, and where in it one can walk.
struct World {
  Mesh mesh;
  Vector3d start_m = Vector3d::Zero();  // a free place on the floor
  Eigen::AlignedBox2d walked_m;         // walks stay within, in plan
};

/// yard, forest, street, corridor, hall, tunnel, stairs, car-park.
std::vector<std::string_view> world_names();

/// Equal seeds make equal worlds. Absent for an unknown name.
std::optional<World> make_world(std::string_view name, std::uint64_t seed);

World yard(Draw& draw);
World forest(Draw& draw);
World street(Draw& draw);
World corridor(Draw& draw);
World hall(Draw& draw);
World tunnel(Draw& draw);
World stairwell(Draw& draw);
World car_park(Draw& draw);

}  // namespace sweepscope::simulation
