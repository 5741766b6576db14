#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// What of a file's messages is kept. Of clouds and of CSV tables always everything.
struct ReadDetail {
  ReadDetail() = default;
  ReadDetail(CloudDetail of_clouds) : clouds(of_clouds) {}

  CloudDetail clouds = CloudDetail::kLines;
  /// Where scans together have more beams than this, only what their headers say: RawLaser::ranges_m stays
  /// empty, and RawScan::first_range is the scan's number among its topic's, in the order of the file.
  std::size_t max_beams = std::numeric_limits<std::size_t>::max();
  /// By that number, 1 for scans that are kept, without their intensities; null: all are. Scans beyond its
  /// end are not kept.
  const std::vector<char>* scans = nullptr;
};

}  // namespace sweepscope
