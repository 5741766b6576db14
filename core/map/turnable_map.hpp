#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/loam/path/sweep_pose.hpp"
#include "core/offset/prepared.hpp"

namespace sweepscope {

/// A beam with a range, before the motor turns it.
struct TurnableBeam {
  std::array<float, 3> p_in_motor_m{};  // in the frame that turns with the motor
  float intensity = 0;                  // 0 if the laser has none
  double time_s = 0;                    // laser clock, seconds since Recording::epoch_ns
};

/// A scan of a TurnableMap. The sweep that it belongs to at an offset is the one that contains
/// middle_s + offset.
struct TurnableScan {
  double middle_s = 0;    // of its first and last beam, laser clock
  std::size_t beams = 0;  // that follow one another in TurnableMap::beams
};

/// A map for every offset: the beams, and all that places them at t_motor = t_laser + offset. A beam's point
/// in the map frame is pose(u) * Rot(axis, motor angle at time_s + offset) * p_in_motor_m, where the pose is
/// that of its scan's sweep and u = (time_s - begin_s) / (end_s - begin_s). What the offset does not change:
/// the trajectory, which was solved for once.
struct TurnableMap {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // of the motor, in the base frame, unit length
  MotorTrack motor;
  std::vector<Sweep> sweeps;        // of the motor, on its clock
  bool moving = false;              // false: the base frame is the map frame
  std::vector<SweepPose> path;      // of a moving rig, ascending; a sweep without a pose is not placed
  std::vector<TurnableScan> scans;  // ascending in time
  std::vector<TurnableBeam> beams;  // in the order of the scans
  std::size_t usable_beams = 0;     // of the recording at these offsets; `beams` may be fewer
};

/// The map of a recording for offsets from `from_s` to `to_s`: of the scans that the motor's track covers at
/// all of them. `path`: a solved trajectory, or null where the rig is stationary. Of more than four million
/// beams only every n-th is kept.
TurnableMap turnable_map(const PreparedRecording& prepared, const std::vector<SweepPose>* path, double from_s,
                         double to_s);

/// The position of each beam in the map frame at an offset, as build_maps() places it along the same
/// trajectory; NaN where it belongs to no sweep.
std::vector<std::array<float, 3>> positions_at(const TurnableMap& map, double offset_s);

/// The same as a cloud, without the beams that belong to no sweep.
MapCloud cloud_at(const TurnableMap& map, double offset_s);

/// At most `count` of the points, evenly distributed in space, as ascending indices: one for each cube of the
/// finest edge (in steps of 2) for which that is not too many, and of the next finer cubes every n-th. What
/// is blurred fills more cubes and keeps more of its points. Points that are NaN are left out.
std::vector<std::uint32_t> evenly_in_space(std::span<const std::array<float, 3>> points_m, std::size_t count);

/// The map of only these beams, given as ascending indices.
TurnableMap with_beams(const TurnableMap& map, std::span<const std::uint32_t> kept);

}  // namespace sweepscope
