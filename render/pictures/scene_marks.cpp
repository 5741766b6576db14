#include <algorithm>
#include <cmath>
#include <optional>

#include "render/drawing/drawing.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {
namespace {

/// As far as it lies in the view: a path may leave it and come back.
void add_path(Drawing& drawing, const Projection& projection, const ScenePath& path) {
  constexpr double kMinStep_px = 2;
  LineMark line{{}, path.width_px, path.colour};
  const auto finish = [&] {
    if (line.points.size() > 1) drawing.add(line);
    line.points.clear();
  };
  std::optional<PixelPoint> last;  // none before the first point, and behind the camera
  for (const Eigen::Vector3d& point_m : path.points_m) {
    const auto at = projection(point_m);
    if (last && at && std::hypot(at->x - last->x, at->y - last->y) < kMinStep_px) continue;
    const auto seen = last && at ? clip(*last, *at, projection.place()) : std::nullopt;
    if (seen) {
      if (line.points.empty()) line.points.push_back(seen->first);
      line.points.push_back(seen->second);
    }
    last = at;
    if (!at || !projection.place().contains(*at)) finish();
  }
  finish();
}

}  // namespace

Drawing flat_marks(const Picture& picture) {
  Drawing drawing;
  for (const View& view : picture.views) {
    const Projection projection(view.scene.camera, view.place);
    for (const ScenePath& path : view.scene.paths) add_path(drawing, projection, path);
    if (view.scene.scanner) drawing.add_all(scanner_marks(*view.scene.scanner, projection));
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
