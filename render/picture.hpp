#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "render/colour_table.hpp"
#include "render/drawing.hpp"
#include "render/image.hpp"
#include "render/points.hpp"

namespace sweepscope {

/// From where a scene is seen, in the map frame.
struct Camera {
  Eigen::Vector3d position_m{0, 0, 10};
  Eigen::Vector3d looks_at_m{0, 0, 0};
  Eigen::Vector3d up{0, 1, 0};
  bool orthographic = true;
  double view_height_m = 10;   // orthographic: how much of the scene the view's height shows
  double view_angle_deg = 30;  // perspective: of the view's height
};

/// Points and what colours them.
struct CloudLayer {
  std::shared_ptr<const ColouredPoints> points;
  double point_size_px = 1;
};

struct Scene {
  std::vector<CloudLayer> clouds;
  ColourScale colours;
  Camera camera;
  Colour background{0, 0, 0};
};

/// A scene in a part of a picture.
struct View {
  PixelRect place;
  Scene scene;
};

/// A picture as data: views of scenes beside each other, and flat marks above them all.
struct Picture {
  int width_px = 0, height_px = 0;
  Colour background{0, 0, 0};
  std::vector<View> views;
  Drawing marks;
};

constexpr int kLeastPictureSidePx = 64, kGreatestPictureSidePx = 8000;

/// Draws it without a display. Edges are smoothed by drawing at twice the size; the same picture gives the
/// same pixels, run after run. A size beyond the limits is ExitCode::kWrongUsage.
Result<Image> draw(const Picture& picture);

}  // namespace sweepscope
