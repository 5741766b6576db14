#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/clouds/points.hpp"
#include "render/drawing/drawing.hpp"
#include "render/images/colour_table.hpp"
#include "render/images/eye_dome.hpp"
#include "render/images/image.hpp"
#include "render/pictures/camera.hpp"
#include "render/pictures/ground_grid.hpp"
#include "render/pictures/scanner_mark.hpp"

class vtkRenderWindow;

namespace sweepscope {

/// Points and their colouring.
struct CloudLayer {
  std::shared_ptr<const ColouredPoints> points;
  double point_size_px = 1;
  bool splats = false;  // points grow where they are sparse
};

/// A line through positions of the map frame, drawn above the points.
struct ScenePath {
  std::vector<Eigen::Vector3d> points_m;
  double width_px = 1;
  Colour colour;
};

/// Text at a position of the map frame.
struct SceneLabel {
  Eigen::Vector3d at_m{0, 0, 0};
  std::string text;
  double size_px = 14;
  Colour colour;
};

struct Scene {
  std::vector<CloudLayer> clouds;
  ColourScale colours;
  std::vector<ScenePath> paths;
  std::vector<SceneLabel> labels;
  std::optional<ScannerMark> scanner;
  std::optional<GroundGrid> grid;    // below the points
  std::optional<Lighting> lighting;  // its sizes in pixels of the picture
  Camera camera;
  Colour background{0, 0, 0};
};

/// A scene in a part of a picture.
struct View {
  PixelRect place;
  Scene scene;
};

/// A picture as data: views of scenes side by side, and flat marks above them. If the background of the
/// picture and of its views has alpha 0, the picture is transparent.
struct Picture {
  int width_px = 0, height_px = 0;
  Colour background{0, 0, 0};
  std::vector<View> views;
  Drawing marks;
};

constexpr int kMinPictureSidePx = 64, kMaxPictureSidePx = 8000;

/// Fails if a picture of that size cannot be drawn (ExitCode::kWrongUsage).
Result<void> check_size(const Picture& picture);

/// Everything flat: the paths and labels of its scenes, then its marks.
Drawing flat_marks(const Picture& picture);

/// Draws it without a display. Edges are smoothed by drawing at twice the size; the same picture gives the
/// same pixels, run after run. A size beyond the limits is ExitCode::kWrongUsage.
Result<Image> draw(const Picture& picture);

/// The size at which VTK draws the picture: larger, for smooth edges.
int drawn_width_px(const Picture& picture);
int drawn_height_px(const Picture& picture);

/// Draws the picture in a window of that size, on screen or not. The window has no renderers before and
/// after. Fails with ExitCode::kWrongUsage and VTK's message if VTK cannot draw it.
Result<Image> draw_in(vtkRenderWindow& window, const Picture& picture);

}  // namespace sweepscope
