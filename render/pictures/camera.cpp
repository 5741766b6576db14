#include "render/pictures/camera.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace sweepscope {
namespace {

constexpr std::array<std::string_view, 4> kViewpointNames{"top", "front", "right", "isometric"};
constexpr double kRoom = 1.06;       // around what is shown
constexpr double kFarAway_m = 1000;  // an orthographic picture does not depend on it

/// From the scene to the camera.
Eigen::Vector3d direction_of(Viewpoint viewpoint) {
  switch (viewpoint) {
    case Viewpoint::kFront:
      return {0, -1, 0};
    case Viewpoint::kRight:
      return {1, 0, 0};
    case Viewpoint::kIsometric:
      return Eigen::Vector3d(1, -1, 1).normalized();
    case Viewpoint::kTop:
      break;
  }
  return {0, 0, 1};
}

std::array<Eigen::Vector3d, 8> corners_of(const Box& box) {
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {(i & 1 ? box.to_m : box.from_m).x(), (i & 2 ? box.to_m : box.from_m).y(),
                  (i & 4 ? box.to_m : box.from_m).z()};
  }
  return corners;
}

}  // namespace

std::span<const std::string_view> viewpoint_names() {
  return kViewpointNames;
}

Result<Viewpoint> viewpoint(std::string_view name) {
  const auto found = std::find(kViewpointNames.begin(), kViewpointNames.end(), name);
  if (found != kViewpointNames.end()) return static_cast<Viewpoint>(found - kViewpointNames.begin());
  return failure(ExitCode::kWrongUsage, fmt::format("There is no viewpoint \"{}\"; there are {}", name,
                                                    fmt::join(kViewpointNames, ", ")));
}

Camera camera_on(const Box& box, Viewpoint viewpoint, bool orthographic, double aspect) {
  Camera camera;
  const Eigen::Vector3d back = direction_of(viewpoint);
  camera.up = viewpoint == Viewpoint::kTop ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, 0, 1);
  camera.looks_at_m = box.middle_m();
  camera.orthographic = orthographic;
  const Eigen::Vector3d right = camera.up.cross(back).normalized(), up = back.cross(right);
  const double slope = std::tan(camera.view_angle_deg * M_PI / 360);
  double half_height_m = 1e-3, distance_m = 1e-3;
  for (const Eigen::Vector3d& corner : corners_of(box)) {
    const Eigen::Vector3d p = corner - camera.looks_at_m;
    const double across = std::max(std::abs(p.dot(up)), std::abs(p.dot(right)) / aspect);
    half_height_m = std::max(half_height_m, across);
    distance_m = std::max(distance_m, p.dot(back) + kRoom * across / slope);
  }
  camera.view_height_m = 2 * kRoom * half_height_m;
  camera.position_m = camera.looks_at_m + (orthographic ? kFarAway_m : distance_m) * back;
  return camera;
}

Camera camera_from_above(const Eigen::Vector2d& centre_m, double view_height_m, bool turned) {
  Camera camera;
  camera.position_m = {centre_m.x(), centre_m.y(), kFarAway_m};
  camera.looks_at_m = {centre_m.x(), centre_m.y(), 0};
  camera.up = turned ? Eigen::Vector3d(-1, 0, 0) : Eigen::Vector3d(0, 1, 0);
  camera.view_height_m = view_height_m;
  return camera;
}

Projection::Projection(const Camera& camera, const PixelRect& place)
    : place_(place),
      origin_m_(camera.orthographic ? camera.looks_at_m : camera.position_m),
      forward_((camera.looks_at_m - camera.position_m).normalized()),
      orthographic_(camera.orthographic) {
  right_ = forward_.cross(camera.up).normalized();
  up_ = right_.cross(forward_);
  const double slope = std::tan(camera.view_angle_deg * M_PI / 360);
  pixels_per_slope_ = place.height / 2 / slope;
  metres_per_px_ = orthographic_ ? camera.view_height_m / place.height
                                 : (camera.looks_at_m - camera.position_m).norm() / pixels_per_slope_;
}

double Projection::metres_per_px_at(const Eigen::Vector3d& point_m) const {
  if (orthographic_) return metres_per_px_;
  return std::max((point_m - origin_m_).dot(forward_), 1e-6) / pixels_per_slope_;
}

std::optional<PixelPoint> Projection::operator()(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d p = point_m - origin_m_;
  double px_per_m = 1 / metres_per_px_;
  if (!orthographic_) {
    const double depth_m = p.dot(forward_);
    if (depth_m <= 1e-6) return std::nullopt;
    px_per_m = pixels_per_slope_ / depth_m;
  }
  return PixelPoint{place_.left + place_.width / 2 + px_per_m * p.dot(right_),
                    place_.top + place_.height / 2 - px_per_m * p.dot(up_)};
}

}  // namespace sweepscope
