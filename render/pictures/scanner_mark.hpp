#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/drawing/drawing.hpp"
#include "render/pictures/camera.hpp"

namespace sweepscope {

/// Where the scanner is and how it is turned, in the map frame: its place, and unit vectors along its x axis
/// (the middle of the scan) and y axis (to the left in the scanning plane).
struct ScannerPose {
  Eigen::Vector3d position_m{0, 0, 0}, x_axis{1, 0, 0}, y_axis{0, 1, 0};
};

/// Half a disc in the scanning plane, as large at every distance.
struct ScannerMark {
  ScannerPose pose;
  double radius_px = 30;
  Colour colour;
};

Drawing scanner_marks(const ScannerMark& mark, const Projection& projection);

}  // namespace sweepscope
