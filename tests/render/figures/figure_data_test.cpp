#include "render/figures/figure_data.hpp"

#include <fmt/format.h>

#include "core/results/estimate_json.hpp"
#include "tests/core/every_look.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

class InterruptedFigures : public test::FolderTest {
 protected:
  /// The names in the cache that end so.
  std::size_t cached(const std::string& ending) const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache"))
      count += entry.path().string().ends_with(ending) ? 1 : 0;
    return count;
  }
  void empty_cache() const {
    std::filesystem::remove_all(folder_ / "cache");
    std::filesystem::create_directory(folder_ / "cache");
  }
  static Recipe recipe() {
    SimulationOptions room;
    room.scene = "room-1";
    room.duration_s = 2.5;
    Recipe recipe;
    recipe.recordings["room"].source = room;
    EstimateSpec& estimate = recipe.estimates["curve"];
    estimate.recording = "room";
    estimate.options.ranges = {{0.022, 0.026, 0.001}};
    return recipe;
  }
  /// The estimate and a map, as text.
  Result<std::string> made(const Job& job) const {
    const Recipe recipe = this->recipe();
    FigureData data(recipe, folder_ / "cache", job, [](const std::string&) {});
    const auto found = data.estimate("curve");
    if (!found) {
      EXPECT_EQ(cached(".json"), 0U);
      return tl::unexpected(found.error());
    }
    const std::vector<MapSpec> specs{{.recording = "room", .offset_s = 0.024, .label = ""}};
    const auto maps = data.maps(specs, true);
    if (!maps) return tl::unexpected(maps.error());
    return fmt::format("{} {} points", estimate_to_json(**found, Timing::kNull), maps->front().cloud->size());
  }
};

TEST_F(InterruptedFigures, NothingUnfinishedIsCachedAndTheNextRunMakesTheSame) {
  empty_cache();
  const std::string whole = made(Job()).value();
  test::expect_interrupted_at_every_look(20, [&](const Job& job) -> std::optional<std::string> {
    empty_cache();
    const auto text = made(job);
    if (text) return *text;
    EXPECT_EQ(text.error().code, ExitCode::kInterrupted);
    EXPECT_EQ(made(Job()).value(), whole);
    EXPECT_EQ(cached(".json"), 1U);
    return std::nullopt;
  });
}

}  // namespace
}  // namespace sweepscope
