#include "render/figures/figure_data.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

#include "core/results/estimate_json.hpp"
#include "tests/core/every_look.hpp"
#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

TEST(FigureData, EveryOptionOfAnEstimateMakesAnotherOneOfIt) {
  const std::map<std::string, std::vector<std::string>> values{
      {"weight-c", {"1", "2"}},
      {"edge-gate-m", {"0.2", "0.3"}},
      {"plane-gate-m", {"0.2", "0.3"}},
      {"search", {"0:100", "100:300"}},
      {"range", {"19:29:1", "19:29:2"}},
      {"around", {"24:0.1:40", "24:0.1:20"}},
      {"solve", {"offset,mount", "offset,play", "offset,encoder", "offset,mount,play"}},
      {"prior", {"mount_deg=2", "mount_mm=5", "play_deg=0.2", "encoder_deg=0.3"}},
      {"over-time", {"10", "20"}}};
  std::set<std::string> lines{in_one_line({})};
  std::size_t options = 1;
  for (const EstimateOption& option : estimate_options()) {
    const auto& all = option.choices.empty() ? values.at(option.name) : option.choices;
    for (const std::string& value : all) {
      EstimateOptions set;
      ASSERT_TRUE(option.set(set, value)) << option.name << " " << value;
      ++options;
      EXPECT_TRUE(lines.insert(in_one_line(set)).second) << option.name << " " << value;
    }
  }
  EXPECT_EQ(lines.size(), options);
}

TEST(FigureData, ResidualsNeedAnEstimateThatSolvesForThemHere) {
  Recipe recipe;
  SimulationOptions room;
  room.scene = "room-1";
  room.duration_s = 1;
  recipe.recordings["room"].source = room;
  recipe.estimates["offset alone"].recording = "room";
  recipe.estimates["of a file"] = {"room", {}, "room.json"};
  FigureData data(recipe, "", Job(), [](const std::string&) {});
  for (const char* name : {"offset alone", "of a file"}) {
    const auto rig = data.solved_rig(name);
    ASSERT_FALSE(rig);
    EXPECT_EQ(rig.error().code, ExitCode::kWrongUsage);
    EXPECT_NE(rig.error().message.find("needs solve"), std::string::npos) << rig.error().message;
  }
}

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
