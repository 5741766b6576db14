#pragma once

#include <memory>
#include <optional>

#include "render/gl/shown_image.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/explorer/maps_picture.hpp"

namespace sweepscope::ui {

/// A small picture of the figure that would be written, drawn in the background.
class FigurePreview {
 public:
  explicit FigurePreview(gl::Context& context) : image_(context) {}

  /// Draws it anew where something of it changed. While the maps' points are being placed it stays as it was.
  void show(Explorer& explorer, const FigureParts& parts, int width_px, int height_px, double pane_aspect);
  void forget() { drawn_of_.reset(); }

  /// 0 before the first one.
  unsigned texture() const { return image_.handle(); }
  int width_px() const { return image_.width_px(); }
  int height_px() const { return image_.height_px(); }
  /// Why there is none; else empty.
  const std::string& problem() const { return problem_; }

 private:
  struct DrawnOf {
    Settings settings;
    FigureParts parts;
    int width_px = 0, height_px = 0;
    double pane_aspect = 1;
    std::array<PlacedCloudPtr, 2> clouds;
    PlacePtr place;

    bool operator==(const DrawnOf&) const = default;
  };
  std::optional<DrawnOf> drawn_of_;
  std::shared_ptr<Result<Image>> coming_;  // empty: none, or it is shown
  gl::ShownImage image_;
  std::string problem_;
};

}  // namespace sweepscope::ui
