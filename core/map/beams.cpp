#include "core/map/beams.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {

std::size_t usable_beams(const Recording& recording, const LaserScan& scan) {
  return static_cast<std::size_t>(
      std::ranges::count_if(recording.ranges(scan), [](float range_m) { return std::isfinite(range_m); }));
}

Beams collect_beams(const Recording& recording, std::span<const char> used, std::size_t stride) {
  Beams beams;
  beams.recording = &recording;
  beams.first_point.push_back(0);
  std::size_t seen = 0;
  for (std::uint32_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    const auto ranges_m = recording.ranges(scan);
    for (std::uint32_t beam = 0; beam < scan.beams && (used.empty() || used[i] != 0); ++beam) {
      if (!std::isfinite(ranges_m[beam]) || seen++ % stride != 0) continue;
      beams.scan.push_back(i);
      beams.beam.push_back(beam);
    }
    beams.first_point.push_back(beams.size());
  }
  return beams;
}

}  // namespace sweepscope
