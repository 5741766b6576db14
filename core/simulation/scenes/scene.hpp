#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/simulation/meshes/mesh.hpp"
#include "core/simulation/motion/recorded_path.hpp"
#include "core/simulation/motion/trajectory.hpp"

namespace sweepscope::simulation {

/// A place to record in, and the motion of the rig: a walk, stationary, or a recorded motion.
struct Scene {
  Mesh mesh;
  std::variant<WalkSpec, Stand, RecordedPath> motion;
};

/// metro-station, parking-area, cemetery, lecture-room, room-1 to room-6.
const std::vector<std::string>& scene_names();

/// Absent for an unknown name.
std::optional<Scene> make_scene(std::string_view name);

Scene metro_station();
Scene parking_area();
Scene cemetery();
Scene lecture_room();
/// `position` in [1, 6]: the rig's position in the furnished room.
Scene room(int position);

}  // namespace sweepscope::simulation
