#pragma once

// The mathematics: docs/algorithms.md, section 2.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/map/map_path.hpp"

namespace sweepscope {

/// Where the base frame was during each scan of a recording, at an offset. The path is the same at every
/// offset, but which sweep a scan belongs to is not: a scan near a reversal goes over to the neighbouring
/// sweep, and one in a pause of the motor belongs to none.
class ScanPoses {
 public:
  ScanPoses(const Recording& recording, const MapPath& path, double offset_s);

  double offset_s() const { return offset_s_; }
  /// Index into poses(), or kNone: the scan is not placed.
  std::uint32_t pose_of(std::size_t scan) const { return pose_of_[scan]; }
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// In the order of time: of each sweep, or along poses from elsewhere of each scan, since those may be far
  /// apart.
  const std::vector<SweepPose>& poses() const { return walk_ ? walk_->sweeps : own_; }
  /// Two poses of each of them, ascending in time.
  std::vector<StampedPose> trajectory() const;

 private:
  void place_along(const Recording& recording, const std::vector<StampedPose>& poses,
                   const std::vector<std::size_t>& sweep_of);
  void place_along_walk(const std::vector<std::size_t>& sweep_of);
  void place_at_rest(const std::vector<Sweep>& sweeps, const std::vector<std::size_t>& sweep_of);

  double offset_s_;
  std::vector<std::uint32_t> pose_of_;
  std::shared_ptr<const SolvedWalk> walk_;
  std::vector<SweepPose> own_;
};

}  // namespace sweepscope
