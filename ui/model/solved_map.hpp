#pragma once

#include <memory>
#include <vector>

#include "core/map/map_path.hpp"
#include "render/comparison/comparison.hpp"
#include "ui/model/loaded.hpp"
#include "ui/model/spatial_order.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// A path along which beams are placed, and the properties of the map at that offset that drawing needs.
struct SolvedMap {
  double offset_s = 0;
  bool provisional = false;  // not solved: the first sweep or second, as if the rig were stationary
  bool lost = false;         // LOAM lost track
  MapPath path;
  std::vector<float> path_height_m;  // of each scan, in the map frame
  std::vector<StampedPose> trajectory;
  DrawOrder order;
  std::vector<HeightRange> sharp_heights;  // above the path: where an offset shows, without the ceiling
  Box main_box;  // of nearly all points that sharp heights show: for the grid, and for colours by elevation
  /// What a view is fitted to: all but stray points, with these heights.
  const Box& extent(Heights heights) const {
    return heights == Heights::kSharp ? sharp_box : heights == Heights::kBelowCeiling ? low_box : whole_box;
  }
  Box sharp_box, low_box, whole_box;
};
using SolvedMapPtr = std::shared_ptr<const SolvedMap>;

/// Whether the rig was stationary, as far as it is known: `assume` goes before the motion test.
bool was_stationary(const Loaded& loaded, std::optional<RigKind> assume);

/// Odometry and mapping at an offset: seconds of work for a moving rig, none for a stationary one.
Result<SolvedMapPtr> solve_map(const Loaded& loaded, double offset_s, std::optional<RigKind> assume,
                               const Job& job);

/// The map of a stationary rig, or of one with known poses; for any other rig, what can be shown before
/// anything is solved.
SolvedMapPtr map_without_solving(const Loaded& loaded, bool standing, double offset_s, const Job& job);

}  // namespace sweepscope::ui
