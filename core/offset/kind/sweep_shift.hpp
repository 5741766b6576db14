#pragma once

// The mathematics: docs/algorithms.md, section 9.

#include <Eigen/Core>
#include <optional>

#include "core/offset/stationary/stationary_points.hpp"

namespace sweepscope {

/// How one sweep lies against another, in the base frame. Leaves and people also differ
/// from sweep to sweep, and a registration follows them; so a shift is returned with its evidence: how many
/// more points lie on the other sweep's surfaces there than at rest. A match counts 1 / (1 + (d / w)^2) at
/// the distance d from its surface, with a width w of about the noise.
///
/// At rest means turned about the motor's axis alone: clocks that drift apart do that to a stationary rig.
struct SweepShift {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();  // where the points fit best
  double rotation_rad = 0;
  double gained_matches = 0;  // there, over those at rest; about 1 where only noise is fitted
  double apart_m = 0;         // from rest, along the surfaces' normals, rms over the matches
  double apart_in_all_m = 0;  // the same, the turn about the motor's axis included

  Eigen::Vector3d far_translation_m = Eigen::Vector3d::Zero();  // result of a search from a distance
  double far_rotation_rad = 0;
  double far_gained_matches = 0;  // there, over those at rest; below 0: worse

  std::size_t features = 0, matches = 0;
};

/// Registers sweep `source` to sweep `target`: the points of each to the patches that the other's form at the
/// same motor angles and beams. Absent where too few match. Directions that the scene does not determine are
/// left at 0.
std::optional<SweepShift> shift_between(const StationaryPoints& points, const LinePool& target,
                                        const LinePool& source, const StationaryGrid& grid);

}  // namespace sweepscope
