#pragma once

// The mathematics: docs/algorithms.md, section 19.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/loam/sweep_matcher.hpp"
#include "core/map/consistency/weakest_direction.hpp"

namespace sweepscope {

/// A feature of a view, in the map frame, and where it was seen from.
struct SeenFeature {
  Eigen::Vector3d p_m, from_m;
  float range_m = 0;
  MatchedKind kind = MatchedKind::kPlane;
  std::size_t sweep = 0;  // of the view, from 0
};

/// What the rig saw in a short time: sweeps of both directions that follow each other.
struct WalkView {
  std::size_t first = 0, end = 0;  // its sweeps are [first, end) of the path
  double begin_s = 0, end_s = 0;   // laser clock
  Pose at;                         // map_from_base in the middle
  double speed_mps = 0;            // mean over the view
  std::vector<SeenFeature> seen;   // a few hundred of those to be matched

  double middle_s() const { return (begin_s + end_s) / 2; }
};

/// Features that have a surface of the other view about them, and how many of them lie on it.
struct SurfaceFit {
  std::size_t matched = 0, near = 0;

  double misfit() const { return matched == 0 ? 0.0 : 1 - double(near) / double(matched); }
};

/// How a view coincides with the surfaces of another: as both were placed, and after the rigid move that
/// makes them coincide best.
struct ViewPair {
  std::size_t features = 0;
  SurfaceFit placed, moved;
  std::size_t gained = 0, given_up = 0;   // features that the move brings onto their surfaces, or takes away
  std::vector<SurfaceFit> placed_sweeps;  // of each sweep of the view
  Pose move;                              // in the map frame; identity in directions that are not determined
  double apart_m = 0;  // by which it moves the features that then lie on their surfaces, mean
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();       // their mean, as placed
  double translation_sigma_m = 0, rotation_sigma_rad = 0;  // of the move, in its least determined directions
  WeakestDirection weakest;                                // of the matches as placed, whose rotation is free

  /// The surfaces determine all of the move.
  bool determined() const;
  /// The move makes most of what was seen coincide, and is small or fits clearly better than none: scenes
  /// that look alike along a direction fit at several places.
  bool coincides() const;
};

/// Matches a view to the map of another one that was about `other_at_m`. Surfaces match if both saw them from
/// the same side.
ViewPair match_views(const SweepMaps& other, const Eigen::Vector3d& other_at_m, const WalkView& view,
                     const MappingOptions& options);

}  // namespace sweepscope
