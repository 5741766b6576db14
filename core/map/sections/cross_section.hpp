#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/geometry/pose.hpp"
#include "core/map/surfaces/surface_thickness.hpp"

namespace sweepscope {

/// A box through a wall or a face of a pillar, in the map frame: a profile across the face is taken from its
/// points.
struct CrossSection {
  Eigen::Vector2d at_m = Eigen::Vector2d::Zero();  // the face's middle, x and y, at the middle height
  double normal_rad = 0;  // direction across the face in the horizontal plane, 0 along x, growing towards y
  double lean_rad = 0;    // by which that direction points up: maps are not level to a degree
  double length_m = 1;    // of the box along the face
  double from_m = 0, to_m = 0;  // heights: z of the map frame
  double reach_m = 0.25;        // of the box to either side of the face

  /// Unit vectors across the face and along it.
  Eigen::Vector3d across() const;
  Eigen::Vector3d along() const;
  /// The face's middle.
  Eigen::Vector3d middle_m() const { return {at_m.x(), at_m.y(), (from_m + to_m) / 2}; }
};

/// Density of a map's points over the signed distance across a face.
struct Profile {
  std::vector<double> distances_mm;    // every 1 mm, about the points' own median
  std::vector<double> density_per_mm;  // of a point; the integral is 1. Empty where there are no points
  std::size_t points = 0;
  double median_mm = 0;    // of the points, along the section's direction from its middle
  double peak_per_mm = 0;  // greatest density
  /// Width at half height: between the outermost crossings of half of the peak. If a wrong offset splits a
  /// face into two layers, both count if the lower peak is above half the higher one. Absent for too few
  /// points.
  std::optional<double> width_at_half_height_mm;
  /// The positions of those crossings, on the axis of distances_mm; present if the width is.
  std::pair<double, double> half_height_mm{0, 0};
  /// The inverse of the peak: how wide the points would be, all as dense as where they are densest (1.06
  /// times the width at half height of a single layer). It also grows where a layer is smeared below half the
  /// peak.
  std::optional<double> integral_width_mm;
};

/// The profile of the points inside the section. The density is smoothed by a Gaussian of sd 3 mm, which
/// would widen a single layer of 10 mm noise from 23.5 to 24.6 mm; this is taken out of the width again
/// (exactly for one layer, to within 1 mm for two). Widths need 300 points.
Profile profile_across(const MapCloud& cloud, const CrossSection& section);

/// The section fitted to the face that lies in it, by a robust plane fit of position, direction (to 6 deg)
/// and lean: a rough section becomes exact on the sharpest map. Absent if the section holds too few points.
std::optional<CrossSection> face_fitted(const MapCloud& cloud, const CrossSection& section);

/// A map, the trajectory of its rig, and its surfaces if they were measured. All must outlive it.
struct MapOnPath {
  const MapCloud* cloud = nullptr;
  std::span<const StampedPose> path;            // ascending in time; map_from_base
  const SurfaceThickness* thickness = nullptr;  // of the cloud; null: measured on a part of it
};

struct SectionSearch {
  Eigen::Vector3d motor_axis = Eigen::Vector3d::UnitX();  // in the base frame
  double length_m = 0.5;                                  // of the section along the face
  double min_height_m = 0.8;  // above or below the rig, where a wrong offset shows in a view from above
  double reach_m = 0.25;
  std::size_t min_points = 600;
  double error_rad = 0.0314;              // the turning that one map alone is tried with: 5 ms at 360 deg/s
  std::optional<Eigen::Vector2d> near_m;  // only faces within near_radius_m of this place in the map
  double near_radius_m = 2;
  double max_width_mm = 45;  // at half height, in the sharpest of the maps
};

/// A section and the evidence for it.
struct FoundSection {
  CrossSection section;           // laid on its face in the sharpest map
  std::size_t sharpest = 0;       // index of that map
  std::vector<double> widths_mm;  // at half height, per map
  /// By how much the motor's turning by 1 rad moves three of four of the face's points across it, at least.
  double lever_m = 0;
};

/// The vertical face at least 0.8 m above or below the rig's path that shows best what the offset does: a
/// plane for the whole length of the section, seen by sweeps of both directions, thin in the sharpest of the
/// maps (no map's points beyond the reach), and of several maps the one whose widths differ most; of one
/// alone the one that would grow widest if sweeps were turned by +-error_rad. Absent if no face is suitable.
std::optional<FoundSection> best_section(std::span<const MapOnPath> maps, const SectionSearch& search = {});

}  // namespace sweepscope
