#include "ui/model/solved_map.hpp"

#include <algorithm>
#include <array>

#include "core/map/offset_map.hpp"
#include "core/offset/prepared.hpp"
#include "render/comparison/comparison_points.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxChosen = 60000;

std::vector<float> path_heights(const Recording& recording, const FixedPath& path) {
  std::vector<float> heights_m(recording.scans.size(), 0);
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    if (path.sweep_of_scan[i] == FixedPath::kNoPose) continue;
    const SweepPose& sweep = path.sweeps[path.sweep_of_scan[i]];
    const double u = (recording.scans[i].first_beam_s - sweep.begin_s) / (sweep.end_s - sweep.begin_s);
    heights_m[i] = static_cast<float>(sweep.at(u).translation_m.z());
  }
  return heights_m;
}

SolvedMap::Span span_of(std::span<const SlabPoints> points, std::size_t axis) {
  const Bounds bounds = bounds_of(points, axis, 0.01);
  return {bounds.from, bounds.to};
}

/// Fills what follows from the path.
void describe_points(const Loaded& loaded, SolvedMap& map) {
  map.path_height_m = path_heights(loaded.recording, map.path);
  std::vector<std::array<float, 3>> places(loaded.beams.size());
  replace_points(loaded.beams, map.path, map.offset_s, places);
  map.order = order_for_drawing(places, kMaxChosen);
  ComparedMap compared;
  compared.path = map.trajectory;
  auto cloud = MapCloud::Ptr(new MapCloud);
  for (const std::uint32_t i : map.order.chosen) {
    MapPoint point{};
    point.x = places[i][0];
    point.y = places[i][1];
    point.z = places[i][2];
    point.time_s = loaded.beams.time_s(i);
    cloud->push_back(point);
  }
  compared.cloud = cloud;
  const std::array all{compared};
  map.sharp_heights = choose_slabs(all, ComparisonOptions());
  const std::vector<float> unused(cloud->size());
  const std::array shown{points_in_slabs(compared, unused, map.sharp_heights)};
  map.x_m = span_of(shown, 0);
  map.y_m = span_of(shown, 1);
  map.z_m = span_of(shown, 2);
}

}  // namespace

bool was_stationary(const Loaded& loaded, std::optional<RigKind> assume) {
  return assume ? *assume == RigKind::kStationary : !loaded.moving.value_or(false);
}

Result<SolvedMapPtr> solve_map(const Loaded& loaded, double offset_s, std::optional<RigKind> assume,
                               const Job& job) {
  const bool standing = was_stationary(loaded, assume);
  if (standing || !loaded.poses.empty()) return map_without_solving(loaded, standing, offset_s);
  MapOptions options;
  options.assume = assume;
  options.walk = loaded.walk->get();
  const std::array offsets_s{offset_s};
  auto built = build_maps(loaded.prepared, offsets_s, options, job);
  if (!built) return tl::unexpected(built.error());
  OffsetMap& solved = built->front();
  loaded.walk->keep(solved.walk);
  auto map = std::make_shared<SolvedMap>();
  map->offset_s = offset_s;
  map->lost = solved.lost;
  map->trajectory = std::move(solved.trajectory);
  const std::vector<char> used = scans_covered(loaded.recording, offset_s, offset_s);
  map->path = solved.moving ? fix_path(loaded.recording, std::move(solved.sweeps), used)
                            : standing_path(loaded.recording, used);
  solved.cloud = nullptr;
  describe_points(loaded, *map);
  return SolvedMapPtr(std::move(map));
}

SolvedMapPtr map_without_solving(const Loaded& loaded, bool standing, double offset_s) {
  constexpr double kShown_s = 1;
  auto map = std::make_shared<SolvedMap>();
  map->offset_s = offset_s;
  std::vector<char> used = scans_covered(loaded.recording, offset_s, offset_s);
  if (!loaded.poses.empty()) {
    map->trajectory = loaded.poses;
    map->path = path_along(loaded.recording, loaded.poses, used);
    describe_points(loaded, *map);
    return map;
  }
  map->provisional = !standing;
  const auto first = std::find(used.begin(), used.end(), 1) - used.begin();
  for (std::size_t i = 0; map->provisional && i < used.size(); ++i) {
    const std::size_t from = std::min<std::size_t>(static_cast<std::size_t>(first), used.size() - 1);
    if (loaded.recording.scans[i].first_beam_s > loaded.recording.scans[from].first_beam_s + kShown_s)
      used[i] = 0;
  }
  map->path = standing_path(loaded.recording, used);
  describe_points(loaded, *map);
  return map;
}

}  // namespace sweepscope::ui
