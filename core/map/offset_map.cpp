#include "core/map/offset_map.hpp"

#include <algorithm>
#include <cmath>

#include "core/map/beam_placer.hpp"
#include "core/map/map_path.hpp"
#include "core/map/pose_reader.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

/// Of the scans that a map is made of: its points, grown by doubling, would be there twice meanwhile.
std::size_t usable_beams(const Recording& recording, const std::vector<std::size_t>& sweep_of,
                         const std::vector<char>& used) {
  std::size_t beams = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    if (sweep_of[i] == kNoSweep || !used[i]) continue;
    const auto ranges_m = recording.ranges(recording.scans[i]);
    beams += static_cast<std::size_t>(
        std::ranges::count_if(ranges_m, [](float range_m) { return std::isfinite(range_m); }));
  }
  return beams;
}

MapCloud::Ptr place_beams(const OffsetProblem& problem, double offset_s,
                          const std::vector<SweepPose>& poses) {
  const Recording& recording = *problem.recording;
  const std::vector<std::size_t> sweep_of = assign_sweeps(recording.scans, problem.motor.sweeps, offset_s);
  MapCloud::Ptr cloud(new MapCloud);
  cloud->points.reserve(usable_beams(recording, sweep_of, problem.scan_used));
  BeamPlacer placer(recording, offset_s);
  auto pose = poses.begin();
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    if (sweep_of[i] == kNoSweep || !problem.scan_used[i]) continue;
    while (pose != poses.end() && pose->sweep < sweep_of[i]) ++pose;
    if (pose == poses.end()) break;
    if (pose->sweep == sweep_of[i]) placer.place(recording.scans[i], *pose, *cloud);
  }
  cloud->width = static_cast<std::uint32_t>(cloud->points.size());
  cloud->height = 1;
  cloud->is_dense = true;
  return cloud;
}

/// Every scan by poses of its own.
MapCloud::Ptr place_beams_along(const OffsetProblem& problem, double offset_s,
                                const std::vector<StampedPose>& poses) {
  const Recording& recording = *problem.recording;
  const std::vector<std::size_t> sweep_of = assign_sweeps(recording.scans, problem.motor.sweeps, offset_s);
  MapCloud::Ptr cloud(new MapCloud);
  cloud->points.reserve(usable_beams(recording, sweep_of, problem.scan_used));
  BeamPlacer placer(recording, offset_s);
  PoseReader reader(poses);
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    if (sweep_of[i] == kNoSweep || !problem.scan_used[i]) continue;
    SweepPose pose;
    pose.sweep = sweep_of[i];
    pose.begin_s = scan.first_beam_s;
    pose.end_s = scan.last_beam_s();
    if (!(pose.end_s > pose.begin_s) || !reader.covers(pose.begin_s, pose.end_s)) continue;
    pose.knots = {reader.at(pose.begin_s), reader.at(pose.end_s)};
    placer.place(scan, pose, *cloud);
  }
  cloud->width = static_cast<std::uint32_t>(cloud->points.size());
  cloud->height = 1;
  cloud->is_dense = true;
  return cloud;
}

OffsetMap build_along(const OffsetProblem& problem, double offset_s, const MapOptions& options) {
  OffsetMap map;
  map.offset_s = offset_s;
  map.moving = true;
  map.trajectory = options.poses;
  map.cloud = place_beams_along(problem, offset_s, options.poses);
  return map;
}

OffsetMap build_one(const OffsetProblem& problem, double offset_s, std::vector<SweepPose> poses) {
  OffsetMap map;
  map.offset_s = offset_s;
  map.cloud = place_beams(problem, offset_s, poses);
  for (const SweepPose& pose : poses) {
    // A sweep's end and the next one's begin are one instant: a quarter in from each keeps the times apart.
    for (const double u : {0.25, 0.75}) {
      const Pose at = pose.at(u);
      map.trajectory.push_back(
          {pose.begin_s + u * (pose.end_s - pose.begin_s), at.translation_m, at.rotation});
    }
  }
  map.sweeps = std::move(poses);
  return map;
}

}  // namespace

std::uint64_t map_memory_bytes(const Recording& recording, std::size_t maps) {
  // All maps share the features; each has the surfaces that LOAM keeps, and its points. Held against what
  // tests/benchmark/memory measures.
  constexpr std::uint64_t kOfFeatures_a_beam = 8, kOfMap_a_beam = 18;
  const std::uint64_t beams = recording.ranges_m.size();
  return beams * (kOfFeatures_a_beam + maps * (kOfMap_a_beam + sizeof(MapPoint)));
}

Result<std::vector<OffsetMap>> build_maps(const PreparedRecording& prepared,
                                          std::span<const double> offsets_s, const MapOptions& options,
                                          const Job& job) {
  const auto [least, greatest] = std::minmax_element(offsets_s.begin(), offsets_s.end());
  const OffsetProblem problem = problem_for(prepared, *least, *greatest);
  const auto path = find_map_path(problem, *least, *greatest, options, job);
  if (!path) return tl::unexpected(path.error());
  job.report("placing", 0);
  std::vector<OffsetMap> maps(offsets_s.size());
  for_each_index(offsets_s.size(), [&](std::size_t i) {
    if (!options.poses.empty())
      maps[i] = build_along(problem, offsets_s[i], options);
    else
      maps[i] = build_one(problem, offsets_s[i],
                          path->moving ? path->walk->sweeps : stationary_poses(problem, offsets_s[i]));
    maps[i].walk = path->walk;
    maps[i].moving = path->moving;
    maps[i].lost = path->walk && path->walk->lost;
    maps[i].warning = path->warning;
  });
  if (job.cancelled()) return failure(ExitCode::kInterrupted, "interrupted while building the map");
  return maps;
}

Result<std::vector<OffsetMap>> build_maps(const Recording& recording, std::span<const double> offsets_s,
                                          const MapOptions& options, const Job& job) {
  const auto prepared = prepare(recording, options.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  return build_maps(*prepared, offsets_s, options, job);
}

}  // namespace sweepscope
