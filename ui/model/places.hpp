#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/job.hpp"
#include "render/comparison/comparison.hpp"
#include "ui/model/placed_cloud.hpp"

namespace sweepscope::ui {

/// A place where the two maps differ, and what a close-up of it is made from.
struct PlaceToLook {
  static constexpr double kAspect = 1.25;  // of a close-up: width over height

  DifferingPlace found;              // the maps are A and B
  double z_m = 0;                    // the median height of its points in the map frame
  std::vector<std::uint32_t> beams;  // that lie there in A or in B, above the sensor's path; ascending

  double height_m() const { return found.region.height_m; }
  double width_m() const { return kAspect * height_m(); }
  /// From above.
  ViewPoint view() const {
    return {{found.region.centre_m.x(), found.region.centre_m.y(), z_m}, height_m(), 0, 90};
  }
};
using PlacePtr = std::shared_ptr<const PlaceToLook>;

/// Where the maps of two placements differ most, best first; see differing_places. Fewer if `job` is
/// cancelled.
std::vector<PlacePtr> find_places(const Placement& a, const Placement& b, const Job& job);

/// The points of a close-up: what is above the sensor's path and below the ceiling.
PlacedCloud place_close_up(const PlaceToLook& place, const Placement& placement, const CloudLook& look,
                           const Placement* other = nullptr, const BeamValues* slow = nullptr);

}  // namespace sweepscope::ui
