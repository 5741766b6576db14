#include "render/drawing/vtk_drawing.hpp"

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

#include "render/drawing/fonts.hpp"

namespace sweepscope {
namespace {

void set_font(vtkTextProperty& property, double size_px, bool bold) {
  property.SetFontFamily(VTK_FONT_FILE);
  property.SetFontFile(font_path(bold).c_str());
  property.SetFontSize(static_cast<int>(std::lround(size_px)));
  property.SetBold(0);
  property.SetItalic(0);
}

class DrawingItem final : public vtkContextItem {
 public:
  static DrawingItem* New();
  // NOLINTNEXTLINE(bugprone-derived-method-shadowing-base-method): as every class of VTK does.
  vtkTypeMacro(DrawingItem, vtkContextItem)

      void adopt(std::shared_ptr<const Drawing> drawing, double scale) {
    drawing_ = std::move(drawing);
    scale_ = scale;
  }

  bool Paint(vtkContext2D* painter) override {
    height_ = GetScene()->GetSceneHeight();
    for (const Drawing::Mark& mark : drawing_->marks()) {
      std::visit([&](const auto& one) { paint(*painter, one); }, mark);
    }
    return true;
  }

 private:
  float x(double pixels) const { return static_cast<float>(pixels * scale_); }
  float y(double pixels) const { return static_cast<float>(height_ - pixels * scale_); }

  void paint(vtkContext2D& painter, const TextMark& mark) const {
    vtkTextProperty& property = *painter.GetTextProp();
    const double size = mark.size_px * scale_;
    set_font(property, size, mark.bold);
    property.SetColor(mark.colour.red / 255.0, mark.colour.green / 255.0, mark.colour.blue / 255.0);
    property.SetOpacity(mark.colour.alpha / 255.0);
    property.SetJustification(mark.align_x == AlignX::kLeft     ? VTK_TEXT_LEFT
                              : mark.align_x == AlignX::kCentre ? VTK_TEXT_CENTERED
                                                                : VTK_TEXT_RIGHT);
    property.SetVerticalJustificationToBottom();
    double baseline = y(mark.at.y);
    if (mark.align_y == AlignY::kTop) baseline -= kCapHeight_em * size;
    if (mark.align_y == AlignY::kMiddle) baseline -= kCapHeight_em / 2 * size;
    if (mark.align_y == AlignY::kBottom) baseline += kDescent_em * size;
    // VTK's anchor is the bottom of the line, below what may hang under the baseline.
    painter.DrawString(std::round(x(mark.at.x)),
                       static_cast<float>(std::round(baseline - kDescent_em * size)), mark.text);
  }

  void paint(vtkContext2D& painter, const LineMark& mark) const {
    if (mark.dash_px > 0) {
      for (const LineMark& dash : dashes_of(mark)) paint(painter, dash);
      return;
    }
    // Quads and not GL lines, whose width and ends differ between machines.
    for (std::size_t i = 1; i < mark.points.size(); ++i) {
      const PixelPoint a = mark.points[i - 1], b = mark.points[i];
      const double length = std::hypot(b.x - a.x, b.y - a.y);
      if (length <= 0) continue;
      const double nx = -(b.y - a.y) / length * mark.width_px / 2,
                   ny = (b.x - a.x) / length * mark.width_px / 2;
      paint(painter,
            PolygonMark{
                {{a.x + nx, a.y + ny}, {b.x + nx, b.y + ny}, {b.x - nx, b.y - ny}, {a.x - nx, a.y - ny}},
                mark.colour});
      if (i + 1 < mark.points.size() && mark.width_px > 1.2)
        paint_joint(painter, b, mark.width_px / 2, mark.colour);
    }
  }

  void paint_joint(vtkContext2D& painter, PixelPoint at, double radius_px, Colour colour) const {
    constexpr int kCorners = 8;
    PolygonMark disc{{}, colour};
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * M_PI * i / kCorners;
      disc.points.push_back({at.x + radius_px * std::cos(angle), at.y + radius_px * std::sin(angle)});
    }
    paint(painter, disc);
  }

  void paint(vtkContext2D& painter, const AreaMark& mark) const {
    for (std::size_t i = 1; i < mark.points.size(); ++i) {
      const PixelPoint a = mark.points[i - 1], b = mark.points[i];
      if (a.x == b.x) continue;
      paint(painter, PolygonMark{{a, b, {b.x, mark.base_y}, {a.x, mark.base_y}}, mark.colour});
    }
  }

  void paint(vtkContext2D& painter, const PolygonMark& mark) const {
    painter.GetPen()->SetLineType(vtkPen::NO_PEN);
    painter.GetBrush()->SetColor(mark.colour.red, mark.colour.green, mark.colour.blue, mark.colour.alpha);
    std::vector<float> corners;
    for (const PixelPoint& point : mark.points) {
      corners.push_back(x(point.x));
      corners.push_back(y(point.y));
    }
    painter.DrawPolygon(corners.data(), static_cast<int>(mark.points.size()));
  }

  std::shared_ptr<const Drawing> drawing_;
  double scale_ = 1, height_ = 0;
};

vtkStandardNewMacro(DrawingItem);

}  // namespace

vtkSmartPointer<vtkContextActor> make_drawing_actor(std::shared_ptr<const Drawing> drawing, double scale) {
  auto item = vtkSmartPointer<DrawingItem>::New();
  item->adopt(std::move(drawing), scale);
  auto actor = vtkSmartPointer<vtkContextActor>::New();
  actor->GetScene()->AddItem(item);
  return actor;
}

}  // namespace sweepscope
