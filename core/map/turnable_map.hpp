#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/map/beams.hpp"
#include "core/map/map_path.hpp"

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

/// A map for every offset, as plain data for a program that has neither recording nor engine, such as a web
/// page: the beams, and all that places them at t_motor = t_laser + offset. A beam's point in the map frame
/// is pose(u) * Rot(axis, motor angle at time_s + offset) * p_in_motor_m, where the pose is that of its
/// scan's sweep and u = (time_s - begin_s) / (end_s - begin_s); see place_beams(). What the offset does not
/// change: the trajectory, which was solved for once.
struct TurnableMap {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // of the motor, in the base frame, unit length
  MotorTrack motor;
  std::vector<Sweep> sweeps;        // of the motor, on its clock
  bool moving = false;              // false: the base frame is the map frame
  std::vector<SweepPose> path;      // of a moving rig, ascending; a sweep without a pose is not placed
  std::vector<TurnableScan> scans;  // ascending in time
  std::vector<TurnableBeam> beams;  // in the order of the scans
};

/// Of the chosen beams, given as ascending indices, along a path without poses from elsewhere.
TurnableMap turnable_map(const Beams& beams, const MapPath& path, std::span<const std::uint32_t> chosen);

/// At most `count` of the points, evenly distributed in space, as ascending indices: one for each cube of the
/// finest edge (in steps of 2) for which that is not too many, and of the next finer cubes every n-th. What
/// is blurred fills more cubes and keeps more of its points. Points that are NaN are left out.
std::vector<std::uint32_t> evenly_in_space(std::span<const std::array<float, 3>> points_m, std::size_t count);

}  // namespace sweepscope
