#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/simulation/mesh.hpp"
#include "core/simulation/recorded_path.hpp"
#include "core/simulation/trajectory.hpp"

namespace sweepscope::simulation {

/// A place to record in, and how it is recorded: walked through, standing still, or moved as somebody
/// recorded.
struct Scene {
  Mesh mesh;
  std::variant<WalkSpec, Stand, RecordedPath> motion;
};

/// metro-station, parking-area, cemetery, lecture-room, room-1 to room-6.
const std::vector<std::string>& scene_names();

/// None for a name that is not a scene's.
std::optional<Scene> make_scene(std::string_view name);

Scene metro_station();
Scene parking_area();
Scene cemetery();
Scene lecture_room();
/// `position` in [1, 6]: where in the one furnished room the rig stands.
Scene room(int position);

}  // namespace sweepscope::simulation
