#pragma once

#include <string>

#include "render/images/image.hpp"

namespace sweepscope {

/// Pixels of an image, from the top left corner.
struct ImageRect {
  int left = 0, top = 0, width = 0, height = 0;

  int right() const { return left + width; }
  int bottom() const { return top + height; }
  int area() const { return width * height; }
  bool operator==(const ImageRect&) const = default;
};

/// A part of an opaque image as a JPEG file, quality 1 to 100, for pictures that are seen for a moment.
/// Colour is kept at full resolution from quality 75 on, and at half below. The rectangle lies within the
/// image.
std::string encode_jpeg(const Image& image, const ImageRect& part, int quality);

/// A part of an opaque image as a PNG file, compressed for speed rather than size.
std::string encode_png_quickly(const Image& image, const ImageRect& part);

}  // namespace sweepscope
