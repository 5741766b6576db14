#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/map_cloud.hpp"
#include "core/geometry/pose.hpp"
#include "core/map/feature_points.hpp"
#include "core/map/offset_map.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "render/pictures/scanner_mark.hpp"

namespace sweepscope {

struct MapConsistency;

/// A map to draw, alone or beside others.
struct ComparedMap {
  std::string label;                       // empty: "offset 24.0 ms", from offset_s
  std::optional<double> offset_s;          // marked in the charts; absent if not known
  MapCloud::ConstPtr cloud;                // in the map frame, z up
  std::vector<StampedPose> path;           // the sensor's path, which heights refer to; may be empty
  double path_height_m = 0;                // the sensor's height if `path` is empty
  std::optional<ScannerPose> scanner;      // at the end of the path; absent if not known
  std::vector<FeatureKind> feature_kinds;  // of each point; empty if not known

  std::shared_ptr<const MapConsistency> consistency;  // null if it is not known
  std::shared_ptr<const SurfaceThickness> thickness;  // of the cloud; null if it was not measured

  std::size_t size() const { return cloud ? cloud->size() : 0; }
};

/// The map at an offset, with the scanner at its end; with `features`, those of the recording, the kind of
/// each point.
ComparedMap compared_map(const Recording& recording, const OffsetMap& map,
                         const FeatureSet* features = nullptr);

/// The thickness of its surfaces; says so where the map does not agree with itself, since each of two walls
/// that should be one may be thin.
std::string in_words(const ComparedMap& map);

/// Measures the thickness of the map's surfaces unless that was done. If `job` is cancelled it stays as it
/// was.
void measure_thickness(ComparedMap& map, const Job& job = {});

}  // namespace sweepscope
