#pragma once

#include <span>
#include <string>

#include "core/map/feature_points.hpp"
#include "core/map/sections/cross_section.hpp"
#include "core/offset/estimate.hpp"
#include "render/charts/chart.hpp"
#include "render/comparison/comparison.hpp"
#include "render/drawing/style.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// A picture with its title and its footer, and the space between them.
struct Page {
  Picture picture;
  Style style;
  double scale = 1;  // of letters and lines; 1 where the picture is 640 x 480 or so
  PixelRect room;
};

/// The look gives size, background and title; without a title the space begins higher. `columns`: the number
/// of parts of about 640 pixels side by side.
Page make_page(const ComparisonOptions& look, double columns = 1);

/// Charts side by side under a title; a single one fills the picture.
Picture charts_picture(std::span<const Chart> charts, const ComparisonOptions& look);

/// A map's profile across a face.
struct NamedProfile {
  std::string name;
  Profile profile;
};

/// The face seen from above in each of the maps, and the density of points across it, with the width at half
/// height of each in millimetres; the densities beside the views or, in a picture that is higher than
/// wide, below them. The profiles are those of the maps, in the same order.
Picture profile_picture(std::span<const ComparedMap> maps, const CrossSection& section,
                        std::span<const NamedProfile> profiles, const ComparisonOptions& look);

/// A scan in the scanner's plane, with its edge and plane points (the paper's Figure 2).
Picture scan_picture(std::span<const ScanPoint> scan, const ComparisonOptions& look);

}  // namespace sweepscope
