#pragma once

#include "ui/model/solved_map.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The view that shows the whole map, until a person moves it.
class FittedView {
 public:
  /// The settings with cameras that show this map, or the clipping box. `beside`: above or beside the
  /// close-ups.
  Settings fitted(Settings settings, const SolvedMap& map, bool beside) const {
    Box box{{map.x_m.from, map.y_m.from, map.z_m.from}, {map.x_m.to, map.y_m.to, map.z_m.to}};
    if (settings.has_box()) box = {settings.box_from_m, settings.box_to_m};
    const PictureShape shape = beside ? shape_ : PictureShape{shape_.aspect, 0, 0};
    for (ViewPoint* view : {&settings.camera_a, &settings.camera_b}) *view = ui::fitted(*view, box, shape);
    return settings;
  }
  /// Whether the map's picture has another shape from now on.
  bool reshape(const PictureShape& shape) { return std::exchange(shape_, shape) != shape; }

  bool moved_by_person = false;

 private:
  PictureShape shape_;
};

}  // namespace sweepscope::ui
