#include "ui/model/solved_map.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/map/place_beams.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "render/comparison/comparison_points.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::size_t kMaxChosen = 60000;

std::vector<float> path_heights(const Recording& recording, const ScanPoses& poses) {
  std::vector<float> heights_m(recording.scans.size(), 0);
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    if (poses.pose_of(i) == ScanPoses::kNone) continue;
    const SweepPose& pose = poses.poses()[poses.pose_of(i)];
    const double u = (recording.scans[i].first_beam_s - pose.begin_s) / (pose.end_s - pose.begin_s);
    heights_m[i] = static_cast<float>(pose.at(u).translation_m.z());
  }
  return heights_m;
}

Box box_of(std::span<const SlabPoints> points, double stray_part) {
  Box box;
  for (const Eigen::Index axis : {0, 1, 2}) {
    const Bounds bounds = bounds_of(points, static_cast<std::size_t>(axis), stray_part);
    box.from_m[axis] = bounds.from;
    box.to_m[axis] = bounds.to;
  }
  return box;
}

/// Fills what follows from the path; unfinished if the job is cancelled.
void describe_points(const Loaded& loaded, SolvedMap& map, const Job& job) {
  map.path_height_m = path_heights(loaded.recording, {loaded.recording, map.path, map.offset_s});
  const auto places = place_beams(loaded.beams, map.path, map.offset_s, job);
  if (job.cancelled()) return;
  map.order = order_for_drawing(places, kMaxChosen);
  if (job.cancelled()) return;
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
  constexpr double kAny_m = std::numeric_limits<double>::infinity(), kFew = 0.01, kStray = 0.001;
  const double ceiling_m = map.sharp_heights.empty() ? kAny_m : map.sharp_heights.back().to_m;
  const std::vector<float> unused(cloud->size());
  const auto seen_with = [&](std::span<const HeightRange> heights) {
    return std::array{points_in_slabs(compared, unused, heights)};
  };
  auto sharp = seen_with(map.sharp_heights);
  if (map.provisional && 10 * sharp[0].above_path_m.size() < cloud->size()) {
    // Of a slow sweep they may be nearly empty.
    map.sharp_heights = {HeightRange{-kAny_m, kAny_m}};
    sharp = seen_with(map.sharp_heights);
  }
  map.main_box = box_of(sharp, kFew);
  map.sharp_box = box_of(sharp, kStray);
  map.low_box = box_of(seen_with(std::array{HeightRange{-kAny_m, ceiling_m}}), kStray);
  map.whole_box = box_of(seen_with(std::array{HeightRange{-kAny_m, kAny_m}}), kStray);
}

/// Of the scans in use only those of the first sweep, or of the first second if that is longer.
void use_beginning(const Loaded& loaded, double offset_s, std::vector<char>& used) {
  const auto& sweeps = loaded.prepared.motor.sweeps;
  const auto& scans = loaded.recording.scans;
  const auto first = std::find(used.begin(), used.end(), 1);
  if (first == used.end()) return;
  double begin_s = scans[static_cast<std::size_t>(first - used.begin())].first_beam_s, shown_s = 1;
  if (!sweeps.empty()) {
    begin_s = std::max(begin_s, sweeps.front().begin_s - offset_s);
    shown_s = std::max(shown_s, sweeps.front().end_s - sweeps.front().begin_s);
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (scans[i].first_beam_s > begin_s + shown_s) used[i] = 0;
}

}  // namespace

bool was_stationary(const Loaded& loaded, std::optional<RigKind> assume) {
  return assume ? *assume == RigKind::kStationary : !loaded.moving.value_or(false);
}

Result<SolvedMapPtr> solve_map(const Loaded& loaded, double offset_s, std::optional<RigKind> assume,
                               const Job& job) {
  const bool standing = was_stationary(loaded, assume);
  if (standing || !loaded.poses.empty()) return map_without_solving(loaded, standing, offset_s, job);
  MapOptions options;
  options.assume = assume;
  options.walk = loaded.walk->get();
  auto path = find_map_path(loaded.prepared, offset_s, offset_s, options, job);
  if (!path) return tl::unexpected(path.error());
  loaded.walk->keep(path->walk);
  auto map = std::make_shared<SolvedMap>();
  map->offset_s = offset_s;
  map->lost = path->lost();
  map->path = std::move(*path);
  map->trajectory = ScanPoses(loaded.recording, map->path, offset_s).trajectory();
  describe_points(loaded, *map, job);
  return SolvedMapPtr(std::move(map));
}

SolvedMapPtr map_without_solving(const Loaded& loaded, bool standing, double offset_s, const Job& job) {
  auto map = std::make_shared<SolvedMap>();
  map->offset_s = offset_s;
  std::vector<char> used = scans_covered(loaded.recording, offset_s, offset_s);
  if (!loaded.poses.empty()) {
    map->trajectory = loaded.poses;
    map->path = path_without_solving(loaded.prepared, std::move(used), loaded.poses);
    describe_points(loaded, *map, job);
    return map;
  }
  map->provisional = !standing;
  if (map->provisional) use_beginning(loaded, offset_s, used);
  map->path = path_without_solving(loaded.prepared, std::move(used));
  describe_points(loaded, *map, job);
  return map;
}

}  // namespace sweepscope::ui
