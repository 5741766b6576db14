#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/loam/mapping.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// A recording's usable beams in the order of their time, in the frame that turns with the motor, so that
/// they do not depend on the offset. The recording must outlive it.
struct Beams {
  const Recording* recording = nullptr;
  std::vector<std::array<float, 3>> p_in_motor_m;
  std::vector<std::uint32_t> scan;       // index into Recording::scans
  std::vector<std::uint32_t> beam;       // of its scan line
  std::vector<std::size_t> first_point;  // scan i's points are [first_point[i], first_point[i + 1])

  std::size_t size() const { return p_in_motor_m.size(); }
  double time_s(std::size_t point) const {  // laser clock
    return recording->scans[scan[point]].beam_s(beam[point]);
  }
  float range_m(std::size_t point) const {
    return recording->ranges(recording->scans[scan[point]])[beam[point]];
  }
};

Beams collect_beams(const Recording& recording);

/// Fixed poses, and which of them each scan lies in.
struct FixedPath {
  std::vector<SweepPose> sweeps;
  std::vector<std::uint32_t> sweep_of_scan;  // index into sweeps, or kNoPose
  static constexpr std::uint32_t kNoPose = ~std::uint32_t{0};
};

/// `used` says per scan whether it is to be placed at all (scans_covered).
FixedPath fix_path(const Recording& recording, std::vector<SweepPose> sweeps, std::span<const char> used);
/// A path on which the rig is stationary at the map frame's origin for the whole recording.
FixedPath standing_path(const Recording& recording, std::span<const char> used);
/// A path along given poses, ascending in time: a pair for each scan, since they may be far apart. Scans that
/// they do not cover have no pose.
FixedPath path_along(const Recording& recording, const std::vector<StampedPose>& poses,
                     std::span<const char> used);

/// Places beams along fixed poses with the motor angle at t_motor = t_laser + offset: the effect of the
/// offset on the map for an unchanged path. Positions are in the map frame; beams outside the path become
/// NaN. In parallel, the same result for any number of threads.
void replace_points(const Beams& beams, const FixedPath& path, double offset_s,
                    std::span<std::array<float, 3>> xyz_m);

/// The same for chosen beams, given in ascending order: xyz_m[k] is the position of beam chosen[k].
void replace_points(const Beams& beams, const FixedPath& path, double offset_s,
                    std::span<const std::uint32_t> chosen, std::span<std::array<float, 3>> xyz_m);

}  // namespace sweepscope
