#include "core/map/place_beams.hpp"

#include <cmath>
#include <limits>

#include "core/map/beam_placer.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

using Positions = std::vector<std::array<float, 3>>;

// `beam_of(k)`: the number of the beam whose position is the k-th.
template <typename BeamOf>
Positions positions_of(std::size_t count, const Beams& beams, const MapPath& path, double offset_s,
                       const BeamOf& beam_of, const Job& job) {
  constexpr std::size_t kGrain = 4096;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const ScanPoses poses(*beams.recording, path, offset_s);
  Positions positions_m(count, {kNan, kNan, kNan});
  for_each_block(count, kGrain, [&](const auto& block) {
    if (job.cancelled()) return;
    BeamPlacer placer(*beams.recording, poses);
    for (std::size_t k = block.begin(); k < block.end(); ++k) {
      const std::size_t i = beam_of(k);
      if (!placer.start(beams.scan[i])) continue;
      const Eigen::Vector3f p_m = placer.p_m(beams.beam[i]).cast<float>();
      positions_m[k] = {p_m.x(), p_m.y(), p_m.z()};
    }
  });
  return positions_m;
}

}  // namespace

Positions place_beams(const Beams& beams, const MapPath& path, double offset_s, const Job& job) {
  return positions_of(
      beams.size(), beams, path, offset_s, [](std::size_t k) { return k; }, job);
}

Positions place_beams(const Beams& beams, const MapPath& path, double offset_s,
                      std::span<const std::uint32_t> chosen, const Job& job) {
  return positions_of(
      chosen.size(), beams, path, offset_s, [&](std::size_t k) { return std::size_t{chosen[k]}; }, job);
}

MapCloud place_scans(const Recording& recording, const ScanPoses& poses, ScanRange scans,
                     const std::optional<Pose>& frame_from_map) {
  constexpr std::size_t kGrain = 32;
  const std::size_t count = scans.end - scans.first;
  std::vector<std::size_t> first_point(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const bool placed = poses.pose_of(scans.first + i) != ScanPoses::kNone;
    first_point[i + 1] =
        first_point[i] + (placed ? usable_beams(recording, recording.scans[scans.first + i]) : 0);
  }
  MapCloud cloud(static_cast<std::uint32_t>(first_point.back()), 1);
  for_each_block(count, kGrain, [&](const auto& block) {
    BeamPlacer placer(recording, poses, frame_from_map);
    for (std::size_t i = block.begin(); i < block.end(); ++i) {
      const std::size_t scan = scans.first + i;
      if (!placer.start(scan)) continue;
      const auto ranges_m = recording.ranges(recording.scans[scan]);
      auto next = cloud.points.begin() + static_cast<std::ptrdiff_t>(first_point[i]);
      for (std::uint32_t beam = 0; beam < ranges_m.size(); ++beam)
        if (std::isfinite(ranges_m[beam])) *next++ = placer.point(beam);
    }
  });
  return cloud;
}

}  // namespace sweepscope
