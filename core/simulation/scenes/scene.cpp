#include "core/simulation/scenes/scene.hpp"

#include <functional>
#include <utility>

namespace sweepscope::simulation {
namespace {

using Maker = std::function<Scene()>;

const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> all = [] {
    std::vector<std::pair<std::string, Maker>> list = {
        {"metro-station", metro_station},
        {"parking-area", parking_area},
        {"cemetery", cemetery},
        {"lecture-room", lecture_room},
    };
    for (int position = 1; position <= 6; ++position)
      list.emplace_back("room-" + std::to_string(position), [position] { return room(position); });
    return list;
  }();
  return all;
}

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& [name, maker] : makers()) list.push_back(name);
    return list;
  }();
  return names;
}

std::optional<Scene> make_scene(std::string_view name) {
  for (const auto& [its_name, maker] : makers())
    if (its_name == name) return maker();
  return std::nullopt;
}

}  // namespace sweepscope::simulation
