#pragma once

// The mathematics: docs/algorithms.md, section 4.

#include <Eigen/Core>
#include <optional>

#include "core/loam/feature_map.hpp"

namespace sweepscope {

/// When neighbours count as a plane or a line. The defaults are those of a map of several sweeps, see
/// MappingOptions.
struct PatchOptions {
  // Three times the points that determine a plane or a line.
  int plane_neighbours = 10;
  int edge_neighbours = 6;    // points that a line is fitted to
  int per_line = 2;           // neighbours from one scan line: more would fit the line instead of the surface
  int min_lines = 4;          // distinct scan lines among a plane's neighbours, at least 3
  int min_edge_lines = 3;     // two lines may cross the edge of one object by chance
  double thickness_m = 0.06;  // RMS distance of the neighbours from the plane or line, at most ...
  double thickness_slope = 0.03;  // ... plus this times the search radius
};

/// A plane through the map's points near a query: (p - centre) . normal is a point's distance.
struct PlanePatch {
  Eigen::Vector3d centre_m, normal;  // a point on it, and its unit normal
};

/// A line through the map's edge points near a query; `direction` has unit length.
struct LinePatch {
  Eigen::Vector3d centre_m, direction;  // a point on it, and its unit direction
};

/// The plane that `neighbours` lie on, or nothing if they are too few, on too few scan lines, collinear, or
/// not flat.
std::optional<PlanePatch> fit_plane(const Neighbours& neighbours, const PatchOptions& options,
                                    double radius_m);

/// The line that `neighbours` lie along, or nothing (LOAM: first eigenvalue more than three times the
/// second).
std::optional<LinePatch> fit_line(const Neighbours& neighbours, const PatchOptions& options, double radius_m);

/// How far a point lies from its patch, along which unit vector.
struct MatchResidual {
  Eigen::Vector3d normal;  // unit: along it the distance grows
  double distance_m = 0;   // of a plane signed, of a line not
  bool has_normal = true;  // not where the point lies on its line
};

/// The signed distance to a plane: LOAM, equation 3.
inline MatchResidual residual_of(const PlanePatch& plane, const Eigen::Vector3d& p_m) {
  return {plane.normal, (p_m - plane.centre_m).dot(plane.normal)};
}

inline MatchResidual residual_of(const LinePatch& line, const Eigen::Vector3d& p_m) {
  constexpr double kOnLine_m = 1e-9;  // nearer, rounding decides where the normal points
  const Eigen::Vector3d d = p_m - line.centre_m;
  const Eigen::Vector3d away_m = d - line.direction.dot(d) * line.direction;
  const double distance_m = away_m.norm();
  if (!(distance_m > kOnLine_m)) return {Eigen::Vector3d::Zero(), distance_m, false};
  return {away_m / distance_m, distance_m};
}

template <typename Patch>
/// Nothing where there is no patch.
std::optional<MatchResidual> residual_of(const std::optional<Patch>& patch, const Eigen::Vector3d& p_m) {
  return patch ? std::optional(residual_of(*patch, p_m)) : std::nullopt;
}

}  // namespace sweepscope
