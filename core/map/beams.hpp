#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// Beams of a recording that returned something, in the order of their time. The recording must outlive it.
struct Beams {
  const Recording* recording = nullptr;
  std::vector<std::uint32_t> scan;       // index into Recording::scans
  std::vector<std::uint32_t> beam;       // of its scan line
  std::vector<std::size_t> first_point;  // scan i's are [first_point[i], first_point[i + 1])

  std::size_t size() const { return scan.size(); }
  double time_s(std::size_t point) const {  // laser clock
    return recording->scans[scan[point]].beam_s(beam[point]);
  }
  float range_m(std::size_t point) const {
    return recording->ranges(recording->scans[scan[point]])[beam[point]];
  }
};

/// 0 if the laser has none.
inline float beam_intensity(const Recording& recording, const LaserScan& scan, std::uint32_t beam) {
  return recording.intensities.empty() ? 0.0f : recording.intensities[scan.first_range + beam];
}

/// The number of beams of a scan that returned something.
std::size_t usable_beams(const Recording& recording, const LaserScan& scan);

/// `used`: per scan, 0 leaves its beams out; empty: all scans are used. Of all these beams every `stride`-th.
Beams collect_beams(const Recording& recording, std::span<const char> used = {}, std::size_t stride = 1);

}  // namespace sweepscope
