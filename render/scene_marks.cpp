#include <algorithm>
#include <cmath>

#include "render/picture.hpp"

namespace sweepscope {
namespace {

void add_path(Drawing& drawing, const Projection& projection, const ScenePath& path) {
  constexpr double kLeastStep_px = 2;
  LineMark line{{}, path.width_px, path.colour};
  const auto finish = [&] {
    if (line.points.size() > 1) drawing.add(line);
    line.points.clear();
  };
  for (const Eigen::Vector3d& point_m : path.points_m) {
    const auto at = projection(point_m);
    if (!at || !projection.place().contains(*at)) {
      finish();
      continue;
    }
    const bool far_enough = line.points.empty() || std::hypot(at->x - line.points.back().x,
                                                              at->y - line.points.back().y) >= kLeastStep_px;
    if (far_enough) line.points.push_back(*at);
  }
  finish();
}

}  // namespace

Drawing flat_marks(const Picture& picture) {
  Drawing drawing;
  for (const View& view : picture.views) {
    const Projection projection(view.scene.camera, view.place);
    for (const ScenePath& path : view.scene.paths) add_path(drawing, projection, path);
    for (const SceneLabel& label : view.scene.labels) {
      const auto at = projection(label.at_m);
      if (!at || !view.place.contains(*at)) continue;
      drawing.add(
          TextMark{*at, label.text, label.size_px, label.colour, AlignX::kCentre, AlignY::kMiddle, true});
    }
  }
  for (const Drawing::Mark& mark : picture.marks.marks()) drawing.add(mark);
  return drawing;
}

}  // namespace sweepscope
