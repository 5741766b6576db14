#pragma once

#include <cstddef>
#include <vector>

#include "render/images/image.hpp"

namespace sweepscope {

/// The depth buffer behind a picture, row by row from the bottom, as OpenGL reads it: 0 at the near plane, 1
/// at the far one. kEmpty: no point was drawn there. A margin of empty pixels surrounds it.
class DepthImage {
 public:
  static constexpr float kEmpty = 1;
  static constexpr int kMargin_px = 16;

  DepthImage() = default;
  DepthImage(int width_px, int height_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  /// Values from one row to the next.
  int stride() const { return width_px_ + 2 * kMargin_px; }
  /// Row 0 is the lowest. The margin may be read too: rows from -kMargin_px on, and as many pixels to either
  /// side.
  float* row(int y) { return values_.data() + first(y); }
  const float* row(int y) const { return values_.data() + first(y); }

 private:
  std::ptrdiff_t first(int y) const {
    return static_cast<std::ptrdiff_t>(y + kMargin_px) * stride() + kMargin_px;
  }

  int width_px_ = 0, height_px_ = 0;
  std::vector<float> values_;
};

/// What the values of a depth buffer mean in the scene.
struct DepthScale {
  bool orthographic = true;
  double near_m = 0, far_m = 1;  // the planes' distances from the camera
  double metres_per_px = 1;      // orthographic: of the picture
  double pixels_per_slope = 1;   // perspective: pixels between directions whose slopes differ by 1
};

/// How points are shaded.
struct Lighting {
  double strength =
      0.75;  // 0: not at all; with this, layers that show through each other lose less than a fifth
  double radius_px = 2;   // of the near neighbours, 1 to 5; the far ones are about three times as far
  double splat_px = 2;    // the size of the points, whose flat faces are no shape
  double noise_m = 0.02;  // of the scanner: depths that differ by less are no shape either

  bool operator==(const Lighting&) const = default;
};

/// Eye-dome lighting (Boucheny 2009) by opposite neighbours in pairs: a pixel behind the middle of two
/// neighbours becomes darker, to a quarter of its brightness, one before it brighter by at most a quarter,
/// and a plane keeps its colours from any side. Pairs with an empty pixel do not count: gaps darken nothing,
/// and single points keep their colours. Shades the pixels that have a depth; `image` has
/// its rows from the bottom, as `depth` has. The same bytes for any number of threads.
Image with_lighting(Image image, const DepthImage& depth, const DepthScale& scale, const Lighting& lighting);

/// Alpha 0 where no point was drawn, and 255 elsewhere. Rows as above.
Image without_gaps(Image image, const DepthImage& depth);

}  // namespace sweepscope
