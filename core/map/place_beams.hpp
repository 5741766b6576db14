#pragma once

// The mathematics: docs/algorithms.md, section 2.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/job.hpp"
#include "core/map/beams.hpp"
#include "core/map/map_path.hpp"
#include "core/map/scan_poses.hpp"

namespace sweepscope {

/// A recording's beams at t_motor = t_laser + offset, along a path that the offset does not change. Map,
/// comparison, report and explorer show these places. In parallel, the same bytes for any number of threads.
/// If `job` is cancelled, places are missing.

/// The position of each beam in the map frame (m); NaN where its scan is not placed.
std::vector<std::array<float, 3>> place_beams(const Beams& beams, const MapPath& path, double offset_s,
                                              const Job& job = {});
/// The same for chosen beams, given in ascending order: position k is that of beam chosen[k].
std::vector<std::array<float, 3>> place_beams(const Beams& beams, const MapPath& path, double offset_s,
                                              std::span<const std::uint32_t> chosen, const Job& job = {});

/// Scans [first, end) of a recording.
struct ScanRange {
  std::size_t first = 0, end = 0;
};
/// All beams of these scans that returned something, without scans that are not placed. `frame_from_map`: in
/// a frame other than the map's.
MapCloud place_scans(const Recording& recording, const ScanPoses& poses, ScanRange scans,
                     const std::optional<Pose>& frame_from_map = std::nullopt);

}  // namespace sweepscope
