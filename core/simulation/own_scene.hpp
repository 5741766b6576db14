#pragma once

#include <string>

#include "core/simulation/scenes/scene.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope::simulation {

struct LoadedScene {
  Scene scene;
  std::string mesh_hash, trajectory_hash;  // content_hash; empty without the file
};

/// Reads the mesh and the trajectory. An error names the file and the place in it.
Result<LoadedScene> load_own_scene(const OwnScene& own);

}  // namespace sweepscope::simulation
