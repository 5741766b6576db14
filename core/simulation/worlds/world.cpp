#include "core/simulation/worlds/world.hpp"

#include <array>
#include <utility>

namespace sweepscope::simulation {
namespace {

constexpr std::uint64_t kWorldPurpose = 100;

using WorldMaker = World (*)(Draw&);
constexpr std::array<std::pair<std::string_view, WorldMaker>, 8> kMakers{{{"yard", yard},
                                                                          {"forest", forest},
                                                                          {"street", street},
                                                                          {"corridor", corridor},
                                                                          {"hall", hall},
                                                                          {"tunnel", tunnel},
                                                                          {"stairs", stairwell},
                                                                          {"car-park", car_park}}};

}  // namespace

std::vector<std::string_view> world_names() {
  std::vector<std::string_view> names;
  for (const auto& [name, maker] : kMakers) names.push_back(name);
  return names;
}

std::optional<World> make_world(std::string_view name, std::uint64_t seed) {
  for (std::uint64_t number = 0; number < kMakers.size(); ++number) {
    if (kMakers[number].first != name) continue;
    Draw draw(seed, kWorldPurpose, number);
    return kMakers[number].second(draw);
  }
  return std::nullopt;
}

}  // namespace sweepscope::simulation
