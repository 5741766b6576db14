#pragma once

// The mathematics: docs/algorithms.md, section 3.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/kinematics.hpp"
#include "core/job.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// How edge and plane points are chosen on a scan line (LOAM, section V.A; section 3.1 of the paper). Half
/// window, regions and edges to match are LOAM's. Where points lie on a plane, noise alone takes one in
/// twenty beyond 2 standard deviations, and none beyond 6. Halved or doubled, those of plane points
/// change the direct method's answers in two simulated rooms by at most 0.009 ms (sweepscope_option_changes
/// of tests/benchmark).
struct FeatureOptions {
  int half_window = 5;  // beams on either side that the curvature is taken over
  double plane_curvature =
      2.0;  // largest curvature of a plane point, in standard deviations of the range noise
  double edge_curvature = 6.0;          // smallest curvature of an edge point, in the same unit ...
  double edge_curvature_slope = 0.006;  // ... and relative to the range: 1.4 beams of 0.25 deg
  int plane_spacing = 18;               // beams: one plane point to match per so many
  int map_spacing = 6;                  // beams: one plane point to build the map from per so many
  int edges_per_region = 2;             // sharpest edge points to match in each of the scan line's regions
  int map_edges_per_region = 5;         // edge points to build the map from, per region
  int regions = 4;                      // of equal size along a scan line, as in LOAM (section V-A)
  double axis_sine = 0.05;  // beams within this sine of the motor's axis (3 deg) do not constrain the offset
                            // and are left out
};

/// A feature, in the frame that turns with the motor, so that it does not depend on the offset.
struct Feature {
  Eigen::Vector3f p_in_motor_m;  // in the frame that the motor turns, with the mount applied
  float range_m = 0;             // as measured
  double time_s = 0;             // of its beam, laser clock, seconds since Recording::epoch_ns
  std::uint32_t scan = 0;        // its scan line, index into Recording::scans
  std::uint16_t beam = 0;        // the index in its scan
  bool sharp = false;            // to be matched; the others only build the map
};

/// One kind of feature over a whole recording, in the order of scans; scan i's are [scan_begin[i],
/// scan_begin[i + 1]).
struct FeatureList {
  std::vector<Feature> features;        // in the order of the scans
  std::vector<std::size_t> scan_begin;  // the first feature of each scan, and the end
};

/// Edge points and plane points of a recording, and the range noise that they were selected with.
struct FeatureSet {
  FeatureList edges, planes;  // on corners, and on flat surfaces
  double range_noise_m = 0;   // 1 sigma, from the scatter of neighbouring beams
};

/// The standard deviation of the range noise, from the second differences of neighbouring ranges: robust
/// against the scene's own edges. At least 2 mm.
double estimate_range_noise_m(const Recording& recording);

/// Extracts the features of every scan line, once for all offsets. Curvature is the distance of a point from
/// the mean of its neighbours on the line, compared with the noise rather than with LOAM's fixed thresholds,
/// which fail at noise of 30 mm. Where many beams are lost at random, gaps within a surface are bridged; lost
/// beams are not features themselves. Points beside an occlusion, on surfaces nearly parallel to the beam,
/// and on the motor's axis are left out.
Result<FeatureSet> extract_features(const Recording& recording, const FeatureOptions& options,
                                    const Job& job);

/// The curvature of every beam of a scan line (m), from which features are selected; NaN if there is none.
std::vector<float> line_curvatures_m(const Recording& recording, std::size_t scan,
                                     const FeatureOptions& options);

}  // namespace sweepscope
