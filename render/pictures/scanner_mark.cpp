#include "render/pictures/scanner_mark.hpp"

#include <cmath>

namespace sweepscope {

Drawing scanner_marks(const ScannerMark& mark, const Projection& projection) {
  constexpr int kSteps = 24;
  Drawing drawing;
  const ScannerPose& pose = mark.pose;
  const auto centre = projection(pose.position_m);
  if (!centre || !projection.place().contains(*centre)) return drawing;
  const double radius_m = mark.radius_px * projection.metres_per_px_at(pose.position_m);
  std::vector<PixelPoint> rim;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle_rad = M_PI * (static_cast<double>(i) / kSteps - 0.5);
    const auto at = projection(
        pose.position_m + radius_m * (std::cos(angle_rad) * pose.x_axis + std::sin(angle_rad) * pose.y_axis));
    if (!at) return drawing;
    rim.push_back(*at);
  }
  Colour veil = mark.colour;
  veil.alpha = 64;
  const double width_px = mark.radius_px / 18;
  drawing.add(PolygonMark{rim, veil});
  std::vector<PixelPoint> outline = rim;
  outline.push_back(rim.front());
  drawing.add(LineMark{outline, width_px, mark.colour});
  drawing.line(*centre, rim[kSteps / 2], width_px, mark.colour);
  PolygonMark dot{{}, mark.colour};
  for (int i = 0; i < kSteps; ++i) {
    const double angle_rad = 2 * M_PI * i / kSteps, radius_px = 0.13 * mark.radius_px;
    dot.points.push_back(
        {centre->x + radius_px * std::cos(angle_rad), centre->y + radius_px * std::sin(angle_rad)});
  }
  drawing.add(dot);
  return drawing;
}

}  // namespace sweepscope
