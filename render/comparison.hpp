#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/io/trajectory_file.hpp"
#include "core/map/map_cloud.hpp"
#include "core/offset/estimate.hpp"
#include "render/image.hpp"

namespace sweepscope {

/// One of the maps to compare.
struct ComparedMap {
  std::string label;               // empty: "offset 24.0 ms", from offset_s
  std::optional<double> offset_s;  // marked in the charts; absent where it is not known
  MapCloud::ConstPtr cloud;        // in the map frame, z up
  std::vector<StampedPose> path;   // the sensor's way, which heights refer to; may be empty
  double path_height_m = 0;        // the sensor's height where `path` is empty
};

/// Heights above the sensor's path (below it: negative).
struct HeightRange {
  double from_m = 0, to_m = 0;
};

/// A part of the map that a close-up shows.
struct Region {
  Eigen::Vector2d centre_m{0, 0};  // x and y in the map frame
  double height_m = 4;             // of the close-up; its width follows from the picture's
};

struct ComparisonOptions {
  int width_px = 1920, height_px = 1200;
  std::string colour_table = "viridis";
  bool light_background = false;
  std::string title;  // empty: the estimate's recording
  /// What the views from above show. A roll error moves points the more the farther they are above or below
  /// the sensor, so near its own height there is nothing to see, and a ceiling hides all below it. Empty:
  /// everything at least 0.8 m below the path, and from 0.8 m above it to just under the ceiling where there
  /// is one.
  std::vector<HeightRange> slabs;
  /// Empty: the place where the maps differ most in sharpness.
  std::optional<Region> close_up;
  bool with_close_up = true;
};

/// Two to four maps side by side from above (orthographic; one camera and one colour scale for all), a
/// close-up of one region of each below, and below those the criteria over the offset with the compared
/// offsets marked. Maps without points and a curve without values are said in words. `estimate` may be null:
/// then no charts.
Result<Image> draw_comparison(std::span<const ComparedMap> maps, const Estimate* estimate,
                              const ComparisonOptions& options = {});

/// Draws it and writes it as PNG; inside the file: the program's version, the equation, the labels and
/// offsets.
Result<void> write_comparison(const std::filesystem::path& path, std::span<const ComparedMap> maps,
                              const Estimate* estimate, const ComparisonOptions& options = {});

}  // namespace sweepscope
