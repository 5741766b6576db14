#include "render/drawing/drawing.hpp"

#include <algorithm>
#include <cmath>

#include "core/io/printable_text.hpp"

namespace sweepscope {

void Drawing::add(Mark mark) {
  if (auto* text = std::get_if<TextMark>(&mark)) text->text = printable_line(text->text);
  marks_.push_back(std::move(mark));
}

std::vector<LineMark> dashes_of(const LineMark& line) {
  if (!(line.dash_px > 0)) return {line};
  std::vector<LineMark> dashes;
  bool drawing = false;
  double left_px = 0;  // until the line goes on or ends
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    const PixelPoint from = line.points[i - 1], to = line.points[i];
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    for (double at = 0; at < length;) {
      if (left_px <= 0) {
        drawing = !drawing;
        left_px = line.dash_px;
        const double t = at / length;
        if (drawing) {
          dashes.push_back(
              {{{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)}}, line.width_px, line.colour});
        }
      }
      const double step = std::min(left_px, length - at), t = (at + step) / length;
      at += step;
      left_px -= step;
      if (drawing) {
        dashes.back().points.push_back({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)});
      }
    }
  }
  return dashes;
}

double baseline_y(const TextMark& mark) {
  switch (mark.align_y) {
    case AlignY::kTop:
      return mark.at.y + kCapHeight_em * mark.size_px;
    case AlignY::kMiddle:
      return mark.at.y + kCapHeight_em / 2 * mark.size_px;
    case AlignY::kBottom:
      return mark.at.y - kDescent_em * mark.size_px;
    case AlignY::kBaseline:
      break;
  }
  return mark.at.y;
}

std::string fit_text(const std::string& text, double size_px, double width_px, bool bold) {
  std::string cut = printable_line(text);
  if (text_width_px(cut, size_px, bold) <= width_px) return cut;
  while (!cut.empty()) {
    const auto is_continuation = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
    while (cut.size() > 1 && is_continuation(cut.back())) cut.pop_back();
    cut.pop_back();
    if (text_width_px(cut + "…", size_px, bold) <= width_px) break;
  }
  return cut + "…";
}

std::optional<std::pair<PixelPoint, PixelPoint>> clip(PixelPoint from, PixelPoint to, const PixelRect& rect) {
  const double step_x = to.x - from.x, step_y = to.y - from.y;
  double enters = 0, leaves = 1;  // parts of the stretch
  const auto narrow = [&](double start, double step, double min, double max) {
    if (step == 0) return start >= min && start <= max;
    const double t1 = (min - start) / step, t2 = (max - start) / step;
    enters = std::max(enters, std::min(t1, t2));
    leaves = std::min(leaves, std::max(t1, t2));
    return enters <= leaves;
  };
  if (!narrow(from.x, step_x, rect.left, rect.right()) || !narrow(from.y, step_y, rect.top, rect.bottom()))
    return std::nullopt;
  const auto at = [&](double t) { return PixelPoint{from.x + t * step_x, from.y + t * step_y}; };
  return std::pair{enters > 0 ? at(enters) : from, leaves < 1 ? at(leaves) : to};
}

}  // namespace sweepscope
