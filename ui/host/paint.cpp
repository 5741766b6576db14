#include "ui/host/paint.hpp"

#include <cmath>

namespace sweepscope::ui {
namespace {

ImVec2 vec(PixelPoint point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

std::vector<ImVec2> vecs(const std::vector<PixelPoint>& points) {
  std::vector<ImVec2> out;
  for (const PixelPoint& point : points) out.push_back(vec(point));
  return out;
}

struct Painter {
  ImDrawList& list;
  const Fonts& fonts;

  void operator()(const TextMark& mark) const { paint_text(list, mark, fonts); }
  void operator()(const LineMark& mark) const {
    for (const LineMark& part : dashes_of(mark)) {
      const auto points = vecs(part.points);
      list.AddPolyline(points.data(), static_cast<int>(points.size()), to_imgui(part.colour), 0,
                       static_cast<float>(part.width_px));
    }
  }
  void operator()(const PolygonMark& mark) const {
    const auto points = vecs(mark.points);
    list.AddConvexPolyFilled(points.data(), static_cast<int>(points.size()), to_imgui(mark.colour));
  }
  /// Column by column: the list fills convex shapes alone.
  void operator()(const AreaMark& mark) const {
    for (std::size_t i = 1; i < mark.points.size(); ++i) {
      const PixelPoint a = mark.points[i - 1], b = mark.points[i];
      list.AddQuadFilled(vec(a), vec(b), vec({b.x, mark.base_y}), vec({a.x, mark.base_y}),
                         to_imgui(mark.colour));
    }
  }
};

}  // namespace

void paint_text(ImDrawList& list, const TextMark& mark, const Fonts& fonts) {
  const Fonts::Sized& sized = fonts.nearest(mark.size_px, mark.bold);
  // A baked size is sharp; another one would be blurred, so small differences are let go.
  const double ratio = mark.size_px / sized.em_px;
  const double stretch = std::abs(ratio - 1) < 0.1 ? 1 : ratio;
  const auto size = static_cast<float>(static_cast<double>(sized.font->FontSize) * stretch);
  const double width = static_cast<double>(sized.font->CalcTextSizeA(size, 1e9f, 0, mark.text.c_str()).x);
  const double ascent = static_cast<double>(sized.font->Ascent) * stretch;
  double x = mark.at.x, y = mark.at.y;
  if (mark.align_x == AlignX::kCentre) x -= width / 2;
  if (mark.align_x == AlignX::kRight) x -= width;
  const double em = sized.em_px * stretch, cap = 0.73 * em;  // how high capital letters are
  if (mark.align_y == AlignY::kTop) y += cap;
  if (mark.align_y == AlignY::kMiddle) y += cap / 2;
  if (mark.align_y == AlignY::kBottom) y -= 0.24 * em;
  list.AddText(sized.font, size,
               {static_cast<float>(std::round(x)), static_cast<float>(std::round(y - ascent))},
               to_imgui(mark.colour), mark.text.c_str());
}

void paint(ImDrawList& list, const Drawing& drawing, const Fonts& fonts) {
  for (const Drawing::Mark& mark : drawing.marks()) std::visit(Painter{list, fonts}, mark);
}

}  // namespace sweepscope::ui
