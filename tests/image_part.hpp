#pragma once

#include <algorithm>

#include "render/drawing/drawing.hpp"
#include "render/images/image.hpp"

namespace sweepscope::test {

/// A copy of a part of a picture that lies in it.
inline Image part_of(const Image& image, const PixelRect& place) {
  Image part(static_cast<int>(place.width), static_cast<int>(place.height));
  for (int y = 0; y < part.height_px; ++y)
    std::copy_n(image.pixel(static_cast<int>(place.left), static_cast<int>(place.top) + y),
                Image::kChannels * static_cast<std::size_t>(part.width_px), part.pixel(0, y));
  return part;
}

}  // namespace sweepscope::test
