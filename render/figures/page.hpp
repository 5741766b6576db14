#pragma once

#include "render/comparison.hpp"
#include "render/drawing.hpp"
#include "render/picture.hpp"
#include "render/style.hpp"

namespace sweepscope {

/// A picture with its title and its last line, and the room between them.
struct Page {
  Picture picture;
  Style style;
  double scale = 1;  // of letters and lines; 1 where the picture is 640 x 480 or so
  PixelRect room;
};

/// The look says size, background and title; without a title the room begins higher. `columns`: how many
/// parts of about 640 pixels lie beside each other.
Page make_page(const ComparisonOptions& look, int columns = 1);

}  // namespace sweepscope
