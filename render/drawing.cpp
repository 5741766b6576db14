#include "render/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {

void Drawing::dashed(PixelPoint from, PixelPoint to, double dash_px, double width_px, Colour colour) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const auto along = [&](double distance) {
    const double t = std::min(distance, length) / length;
    return PixelPoint{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
  };
  for (double begin = 0; begin < length; begin += 2 * dash_px) {
    line(along(begin), along(begin + dash_px), width_px, colour);
  }
}

std::string fit_text(const std::string& text, double size_px, double width_px, bool bold) {
  if (text_width_px(text, size_px, bold) <= width_px) return text;
  std::string cut = text;
  while (!cut.empty()) {
    const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
    while (cut.size() > 1 && is_continuation(cut.back())) cut.pop_back();
    cut.pop_back();
    if (text_width_px(cut + "…", size_px, bold) <= width_px) break;
  }
  return cut + "…";
}

}  // namespace sweepscope
