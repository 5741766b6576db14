#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "render/images/colour_table.hpp"

namespace sweepscope {

/// A position in a picture: pixels from its top left corner, y downwards.
struct PixelPoint {
  double x = 0, y = 0;
};

struct PixelRect {
  double left = 0, top = 0, width = 0, height = 0;

  double right() const { return left + width; }
  double bottom() const { return top + height; }
  bool contains(PixelPoint point) const {
    return point.x >= left && point.x <= right() && point.y >= top && point.y <= bottom();
  }
  /// The rectangle without a margin on every side.
  PixelRect inset(double margin) const {
    return {left + margin, top + margin, width - 2 * margin, height - 2 * margin};
  }
};

enum class AlignX { kLeft, kCentre, kRight };
enum class AlignY { kTop, kMiddle, kBaseline, kBottom };

struct TextMark {
  PixelPoint at;  // what the alignment refers to
  std::string text;
  double size_px = 14;  // of the font's em
  Colour colour;
  AlignX align_x = AlignX::kLeft;
  AlignY align_y = AlignY::kBaseline;
  bool bold = false;
};

struct LineMark {
  std::vector<PixelPoint> points;
  double width_px = 1;
  Colour colour;
  double dash_px = 0;  // the length of the dashes and of the gaps between them; 0: no gaps
};

struct PolygonMark {  // convex, filled
  std::vector<PixelPoint> points;
  Colour colour;
};

struct AreaMark {  // filled between a line, x ascending or descending, and a height
  std::vector<PixelPoint> points;
  double base_y = 0;
  Colour colour;
};

/// Flat marks, later ones above earlier ones: text, lines, filled shapes. Data alone: vtk_drawing paints it
/// as pixels, vector_file writes it as shapes and text.
class Drawing {
 public:
  using Mark = std::variant<TextMark, LineMark, PolygonMark, AreaMark>;

  void add(Mark mark);
  void add_all(const Drawing& other) {
    marks_.insert(marks_.end(), other.marks_.begin(), other.marks_.end());
  }
  void line(PixelPoint from, PixelPoint to, double width_px, Colour colour) {
    add(LineMark{{from, to}, width_px, colour});
  }
  void fill(const PixelRect& rect, Colour colour) {
    add(PolygonMark{{{rect.left, rect.top},
                     {rect.right(), rect.top},
                     {rect.right(), rect.bottom()},
                     {rect.left, rect.bottom()}},
                    colour});
  }
  /// The outline, inside the rectangle.
  void frame(const PixelRect& rect, double width_px, Colour colour) {
    fill({rect.left, rect.top, rect.width, width_px}, colour);
    fill({rect.left, rect.bottom() - width_px, rect.width, width_px}, colour);
    fill({rect.left, rect.top + width_px, width_px, rect.height - 2 * width_px}, colour);
    fill({rect.right() - width_px, rect.top + width_px, width_px, rect.height - 2 * width_px}, colour);
  }
  void dashed(PixelPoint from, PixelPoint to, double dash_px, double width_px, Colour colour) {
    add(LineMark{{from, to}, width_px, colour, dash_px});
  }

  const std::vector<Mark>& marks() const { return marks_; }

 private:
  std::vector<Mark> marks_;
};

/// The dashes of a line as separate lines, or the line itself if it is not dashed.
std::vector<LineMark> dashes_of(const LineMark& line);

/// The height of capital letters and the depth of descenders below the baseline, in ems.
constexpr double kCapHeight_em = 0.73, kDescent_em = 0.24;

/// The position of a text's baseline.
double baseline_y(const TextMark& mark);

/// The width of a line of text.
double text_width_px(const std::string& text, double size_px, bool bold = false);

/// The text, shortened with an ellipsis if it is wider than the space.
std::string fit_text(const std::string& text, double size_px, double width_px, bool bold = false);

/// The part of a line segment that lies in a rectangle; absent if there is none. An end that lies inside is
/// kept exactly.
std::optional<std::pair<PixelPoint, PixelPoint>> clip(PixelPoint from, PixelPoint to, const PixelRect& rect);

}  // namespace sweepscope
