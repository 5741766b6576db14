#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/offset/estimate.hpp"
#include "render/comparison/colouring.hpp"
#include "render/comparison/compared_map.hpp"
#include "render/drawing/style.hpp"
#include "render/pictures/camera.hpp"
#include "render/pictures/depth_cues.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// Heights above the sensor's path (below it: negative).
struct HeightRange {
  double from_m = 0, to_m = 0;
};

/// A part of the map that a close-up shows from above.
struct Region {
  Eigen::Vector2d centre_m{0, 0};  // x and y in the map frame
  double height_m = 4;             // of the close-up; its width follows from the picture's
};

/// A place where maps differ in sharpness: a blurred surface fills more cells.
struct DifferingPlace {
  Region region;                   // what a close-up of it shows
  std::vector<std::size_t> cells;  // of 5 cm, above the sensor's path, that each map fills there

  std::size_t sharpest() const;      // the map that fills the fewest
  std::size_t most_blurred() const;  // and the most
  double ratio() const;              // of their cells, at least 1
};

struct ComparisonOptions {
  int width_px = 1920, height_px = 1200;
  Background background = Background::kDark;
  std::string title;  // empty: the estimate's recording
  ColourBy colour_by = ColourBy::kElevation;
  std::string colour_table = "viridis";
  std::optional<ValueRange> colour_range;  // empty: of the points shown, without outliers
  double point_size_px = 1;                // at 1920 x 1200
  Viewpoint viewpoint = Viewpoint::kTop;
  bool perspective = false;
  std::optional<Camera> camera;  // instead of the viewpoint
  DepthCues cues;                // of the overviews; the close-ups are plans
  std::optional<Box> box;        // only what is inside, fitted to the view
  /// The heights shown. A roll error moves points in proportion to their height above or below the sensor, so
  /// it is not visible near the sensor's own height, and a ceiling hides everything below it. Empty: from
  /// above, everything at least 0.8 m below the path, and from 0.8 m above it to just under the ceiling if
  /// there is one; from other viewpoints, everything under the ceiling.
  std::vector<HeightRange> slabs;
  /// Empty: the place where the maps differ most in sharpness.
  std::optional<Region> close_up;
  bool with_close_up = true;
  bool each_own_view = false;  // for maps of different places: each fills its panel
};

/// Fails with ExitCode::kWrongUsage if the size is too small for a comparison.
Result<void> check_size(const ComparisonOptions& options);

/// One to four maps side by side, with the same camera and colour scale, a close-up of one region of each
/// below, and below those the criteria over the offset with the compared offsets marked. For maps without
/// points and a curve without values the picture has a text instead. `estimate` may be null: then there are
/// no charts.
Result<Picture> comparison_picture(std::span<const ComparedMap> maps, const Estimate* estimate,
                                   const ComparisonOptions& options = {});

/// The places where the maps differ most, best first and at most 12: the first is what the picture's
/// close-ups show unless the options say otherwise. Without a difference, none. Errors are those of the
/// picture.
Result<std::vector<DifferingPlace>> differing_places(std::span<const ComparedMap> maps,
                                                     const Estimate* estimate,
                                                     const ComparisonOptions& options = {});

/// The metadata of that picture's file: the program's version, the equation, the maps and offsets, and how
/// they are shown.
std::vector<PngText> comparison_texts(std::span<const ComparedMap> maps, const ComparisonOptions& options);

}  // namespace sweepscope
