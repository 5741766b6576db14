#pragma once

#include <span>
#include <string>

#include "core/map/cross_section.hpp"
#include "core/map/feature_points.hpp"
#include "core/offset/estimate.hpp"
#include "render/chart.hpp"
#include "render/comparison.hpp"

namespace sweepscope {

/// Charts beside each other under a title; one alone fills the picture.
Picture charts_picture(std::span<const Chart> charts, const ComparisonOptions& look);

/// A map's profile across a face.
struct NamedProfile {
  std::string name;
  Profile profile;
};

/// The face seen from above in each of the maps, and the density of points across it, with the width at half
/// height of each in millimetres. The profiles are those of the maps, in the same order.
Picture profile_picture(std::span<const ComparedMap> maps, const CrossSection& section,
                        std::span<const NamedProfile> profiles, const ComparisonOptions& look);

/// A scan in the scanner's plane, with its edge and plane points (the paper's Figure 2).
Picture scan_picture(std::span<const ScanPoint> scan, const ComparisonOptions& look);

}  // namespace sweepscope
