#pragma once

// The mathematics: docs/rig.md.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/loam/sweep_features.hpp"
#include "core/rig_solve/rig_unknowns.hpp"

namespace sweepscope {

struct RigCloudOptions {
  bool near_reversals = false;       // beams near the reversals too, except while the gear crosses its play
  std::size_t max_points = 120'000;  // of more points every n-th is used
};

/// The plane features of a stationary rig, placed in the base frame. Entry i of each list is the same point.
struct RigCloud {
  std::vector<RigGeometry::Placed> placed;
  std::vector<Eigen::Vector3d> p_m;    // in the base frame
  std::vector<double> angle_rad;       // of the encoder
  std::vector<std::uint32_t> feature;  // index into the problem's plane features, ascending
};

/// Places the features with a rig that deviates from the rig file by `rig`, at its offset.
RigCloud place_with_rig(const OffsetProblem& problem, const RigUnknowns& rig, const RigCloudOptions& options);

}  // namespace sweepscope
