#pragma once

#include "ui/model/solved_map.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The view that shows the whole map, until a person moves it.
class FittedView {
 public:
  /// The settings with cameras that show this box, or the clipping box. `beside`: above or beside the
  /// close-ups.
  Settings fitted(Settings settings, Box box, bool beside) {
    if (settings.has_box()) box = {settings.box_from_m, settings.box_to_m};
    spare_height_ = beside ? ui::spare_height(settings.camera_a, box, shape_.aspect) : 0;
    const PictureShape shape = beside ? shape_ : PictureShape{shape_.aspect, 0, 0};
    for (ViewPoint* view : {&settings.camera_a, &settings.camera_b})
      *view = ui::fitted(*view, box, shape, settings.perspective);
    return settings;
  }
  /// See ui::spare_height: of the view that was fitted last, for larger close-ups.
  double spare_height() const { return spare_height_; }
  /// Whether the map's picture has another shape from now on.
  bool reshape(const PictureShape& shape) { return std::exchange(shape_, shape) != shape; }

  bool moved_by_person = false;

 private:
  PictureShape shape_;
  double spare_height_ = 0;
};

}  // namespace sweepscope::ui
