#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string_view>

#include "core/error.hpp"
#include "render/drawing/drawing.hpp"

namespace sweepscope {

/// The viewpoint of a scene, in the map frame.
struct Camera {
  Eigen::Vector3d position_m{0, 0, 10};
  Eigen::Vector3d looks_at_m{0, 0, 0};
  Eigen::Vector3d up{0, 1, 0};
  bool orthographic = true;
  double view_height_m = 10;   // orthographic: how much of the scene the view's height shows
  double view_angle_deg = 30;  // perspective: of the view's height
};

/// A part of a map: from the minimum to the maximum coordinates.
struct Box {
  Eigen::Vector3d from_m{0, 0, 0}, to_m{1, 1, 1};

  Eigen::Vector3d middle_m() const { return (from_m + to_m) / 2; }
};

/// The named directions to look in: top (x to the right, y up), front (along +y), right (along -x) and
/// isometric (equally from x, -y and z).
enum class Viewpoint { kTop, kFront, kRight, kIsometric };

/// "top", "front", "right", "isometric", in the order of the enumeration.
std::span<const std::string_view> viewpoint_names();
/// An unknown name is ExitCode::kWrongUsage; the message lists the known names.
Result<Viewpoint> viewpoint(std::string_view name);

/// The camera that shows the whole box with a small margin, in a view of that aspect (width over height).
Camera camera_on(const Box& box, Viewpoint viewpoint, bool orthographic, double aspect);

/// Seen from above, orthographic: x to the right and y up; or turned, y to the right and x down. The view's
/// height shows `view_height_m`.
Camera camera_from_above(const Eigen::Vector2d& centre_m, double view_height_m, bool turned = false);

/// Projects points of the map frame into a picture, by the camera of a view at a position.
class Projection {
 public:
  Projection(const Camera& camera, const PixelRect& place);

  /// Nothing where the point is behind a perspective camera.
  std::optional<PixelPoint> operator()(const Eigen::Vector3d& point_m) const;
  /// At the depth of what the camera looks at.
  double metres_per_px() const { return metres_per_px_; }
  /// At the depth of a point, which is before the camera.
  double metres_per_px_at(const Eigen::Vector3d& point_m) const;
  const PixelRect& place() const { return place_; }

 private:
  PixelRect place_;
  Eigen::Vector3d origin_m_, right_, up_, forward_;
  bool orthographic_;
  double metres_per_px_, pixels_per_slope_;
};

}  // namespace sweepscope
