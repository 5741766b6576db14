#include "core/map/offset_map.hpp"

#include <algorithm>

#include "core/map/place_beams.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
OffsetMap map_along(const Recording& recording, const MapPath& path, double offset_s) {
  const ScanPoses poses(recording, path, offset_s);
  OffsetMap map;
  map.offset_s = offset_s;
  map.cloud = MapCloud::Ptr(new MapCloud(place_scans(recording, poses, {0, recording.scans.size()})));
  map.sweeps = poses.poses();
  map.trajectory = path.poses.empty() ? poses.trajectory() : path.poses;
  map.walk = path.walk;
  map.moving = path.moving;
  map.lost = path.lost();
  map.consistency = path.consistency;
  map.warning = path.warning;
  return map;
}

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
  const auto [min_s, max_s] = std::minmax_element(offsets_s.begin(), offsets_s.end());
  const auto path = find_map_path(prepared, *min_s, *max_s, options, job);
  if (!path) return tl::unexpected(path.error());
  job.report("placing", 0);
  std::vector<OffsetMap> maps(offsets_s.size());
  for_each_index(offsets_s.size(),
                 [&](std::size_t i) { maps[i] = map_along(*prepared.recording, *path, offsets_s[i]); });
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
