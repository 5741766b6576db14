#include "render/comparison/comparison_marks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <utility>
#include <vector>

#include "render/charts/ticks.hpp"
#include "render/drawing/plus_minus.hpp"

namespace sweepscope {
namespace {

constexpr double kBodyPx = 14, kAxisArmPx = 26, kAxisLetterPx = 12;

struct ScaleBar {
  double length_px = 0;
  std::string label;
};

/// A round length, about an eighth of the view.
ScaleBar scale_bar_of(const Projection& projection, double scale) {
  const double metres_per_px = projection.metres_per_px();
  const double length_m = round_length(metres_per_px * std::min(180 * scale, projection.place().width * 0.2));
  return {length_m / metres_per_px,
          length_m >= 1 ? fmt::format("{:.0f} m", length_m) : fmt::format("{:.0f} cm", 100 * length_m)};
}

void add_bar(Drawing& drawing, PixelPoint left_end, double length_px, Colour colour, double scale) {
  const double tick = 6 * scale, width = std::max(1.0, std::round(2 * scale));
  drawing.fill({left_end.x, left_end.y - width, length_px, width}, colour);
  drawing.fill({left_end.x, left_end.y - tick, width, tick}, colour);
  drawing.fill({left_end.x + length_px - width, left_end.y - tick, width, tick}, colour);
}

/// Above the view at its right, where it hides no points.
void add_scale_bar_above(Drawing& drawing, const Projection& projection, const Style& style, double scale) {
  const ScaleBar bar = scale_bar_of(projection, scale);
  const double y = projection.place().top - 12 * scale, left = projection.place().right() - bar.length_px;
  add_bar(drawing, {left, y}, bar.length_px, style.text, scale);
  drawing.add(TextMark{{left - 9 * scale, y}, bar.label, kBodyPx * scale, style.text, AlignX::kRight});
}

/// What keeps marks legible above points.
Colour veil_of(const Style& style) {
  Colour veil = style.map_panel;
  veil.alpha = style.map_panel.alpha == 0 ? 0 : 215;
  return veil;
}

/// At the view's lower left, on a ground that keeps it legible above points.
void add_scale_bar_inside(Drawing& drawing, const Projection& projection, const Style& style, double scale) {
  const ScaleBar bar = scale_bar_of(projection, scale);
  const PixelRect& place = projection.place();
  const double size = kBodyPx * scale, pad = 10 * scale, text_width = text_width_px(bar.label, size);
  const PixelRect ground{place.left + pad, place.bottom() - pad - size - 1.4 * pad,
                         bar.length_px + text_width + 3 * pad, size + 1.4 * pad};
  drawing.fill(ground, veil_of(style));
  const PixelPoint left_end{ground.left + pad, ground.bottom() - pad};
  add_bar(drawing, left_end, bar.length_px, style.map_highlight, scale);
  drawing.add(TextMark{{left_end.x + bar.length_px + pad, left_end.y}, bar.label, size, style.map_highlight});
}

void add_axes_inside(Drawing& drawing, const Projection& projection, const Camera& camera, const Style& style,
                     double scale) {
  const double pad = 10 * scale, side = axes_side_px(scale);
  const PixelRect& place = projection.place();
  if (place.width < 2 * side || place.height < 1.4 * side) return;
  const PixelRect ground{place.left + pad, place.bottom() - pad - side, side, side};
  drawing.fill(ground, veil_of(style));
  add_axes(drawing, ground, camera, style.map_highlight, scale);
}

std::string describe_side(double near_m, double far_m, const char* side) {
  if (std::isinf(far_m)) return fmt::format("{:.1f} m and more {} the sensor's path", near_m, side);
  return fmt::format("{:.1f} to {:.1f} m {} the sensor's path", near_m, far_m, side);
}

std::string describe_slab(const HeightRange& slab) {
  if (slab.from_m >= 0) return describe_side(slab.from_m, slab.to_m, "above");
  if (slab.to_m <= 0) return describe_side(-slab.to_m, -slab.from_m, "below");
  if (std::isinf(slab.from_m) && std::isinf(slab.to_m)) return "all heights";
  if (std::isinf(slab.from_m)) return fmt::format("up to {:.1f} m above the sensor's path", slab.to_m);
  if (std::isinf(slab.to_m))
    return fmt::format("from {:.1f} m below the sensor's path upwards", -slab.from_m);
  return fmt::format("{:.1f} m below to {:.1f} m above the sensor's path", -slab.from_m, slab.to_m);
}

void add_words(Drawing& drawing, const PixelRect& place, const std::string& headline,
               std::span<const std::string> lines, const Style& style, double scale) {
  const double size = kBodyPx * scale, step = 1.6 * size, room = place.width - 40 * scale;
  const double x = place.left + place.width / 2;
  double y = place.top + place.height / 2 - step * static_cast<double>(lines.size()) / 2;
  drawing.add(TextMark{{x, y},
                       fit_text(headline, 1.3 * size, room, true),
                       1.3 * size,
                       style.text,
                       AlignX::kCentre,
                       AlignY::kMiddle,
                       true});
  y += 0.3 * size;
  for (const std::string& line : lines) {
    y += step;
    drawing.add(TextMark{
        {x, y}, fit_text(line, size, room), size, style.faint_text, AlignX::kCentre, AlignY::kMiddle});
  }
}

}  // namespace

double axes_side_px(double scale) {
  return 1.3 * kAxisArmPx * scale + 2.4 * kAxisLetterPx * scale;
}

void add_axes(Drawing& drawing, const PixelRect& ground, const Camera& camera, Colour colour, double scale) {
  const double arm_px = kAxisArmPx * scale, size = kAxisLetterPx * scale, side = ground.width;
  const Eigen::Vector3d forward = (camera.looks_at_m - camera.position_m).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized(), up = right.cross(forward);
  const PixelPoint middle{ground.left + side / 2, ground.top + side / 2};
  constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
  Eigen::Vector2d sum(0, 0);  // the origin sits opposite to where the arms go, so that all fits
  std::vector<std::pair<const char*, Eigen::Vector2d>> arms;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector2d arm(right[axis], -up[axis]);
    if (arm.norm() < 0.2) continue;
    arms.emplace_back(kAxes[static_cast<std::size_t>(axis)], arm);
    sum += arm;
  }
  const Eigen::Vector2d origin(middle.x - 0.5 * arm_px * sum.x(), middle.y - 0.5 * arm_px * sum.y());
  for (const auto& [name, arm] : arms) {
    const Eigen::Vector2d tip = origin + arm_px * arm, letter = tip + 0.75 * size * arm.normalized();
    const Eigen::Vector2d back = tip - 6 * scale * arm.normalized();
    const Eigen::Vector2d aside = 3.2 * scale * Eigen::Vector2d(-arm.y(), arm.x()).normalized();
    drawing.line({origin.x(), origin.y()}, {back.x(), back.y()}, 1.5 * scale, colour);
    drawing.add(PolygonMark{{{tip.x(), tip.y()},
                             {back.x() + aside.x(), back.y() + aside.y()},
                             {back.x() - aside.x(), back.y() - aside.y()}},
                            colour});
    drawing.add(TextMark{{letter.x(), letter.y()}, name, size, colour, AlignX::kCentre, AlignY::kMiddle});
  }
}

std::string describe_slabs(std::span<const HeightRange> slabs) {
  std::string text;
  for (const HeightRange& slab : slabs | std::views::reverse) {
    if (!text.empty()) text += ", ";
    text += describe_slab(slab);
  }
  constexpr std::string_view kPath = "the sensor's path";  // named once is enough
  const std::size_t first = text.find(kPath);
  for (std::size_t at = first; (at = text.find(kPath, at + 1)) != std::string::npos;) {
    text.replace(at, kPath.size(), "it");
  }
  return text;
}

void add_heading(Drawing& drawing, const ComparisonLayout& layout, const std::string& title,
                 const std::string& how_it_is_seen, double width_px, const Style& style) {
  const double room = width_px - 2 * layout.margin, title_size = 24 * layout.scale,
               size = kBodyPx * layout.scale;
  const std::string shown = title.empty() ? "Comparison of maps" : title;
  drawing.add(TextMark{layout.title, fit_text(shown, title_size, room, true), title_size, style.text,
                       AlignX::kLeft, AlignY::kBaseline, true});
  drawing.add(TextMark{layout.subtitle, fit_text(how_it_is_seen, size, room), size, style.faint_text});
}

void add_label(Drawing& drawing, PixelPoint baseline, double width_px, const std::string& label,
               Colour colour, const Style& style, double scale) {
  const double size = 17 * scale, chip = std::round(12 * scale);
  drawing.fill({baseline.x, std::round(baseline.y - chip), chip, chip}, colour);
  const double left = chip + 9 * scale;
  drawing.add(TextMark{{baseline.x + left, baseline.y},
                       fit_text(label, size, 0.6 * width_px, true),
                       size,
                       style.text,
                       AlignX::kLeft,
                       AlignY::kBaseline,
                       true});
}

void add_overview_marks(Drawing& drawing, const Projection& projection, const Camera& camera,
                        const Style& style, double scale) {
  if (camera.orthographic) add_scale_bar_above(drawing, projection, style, scale);
  add_axes_inside(drawing, projection, camera, style, scale);
  drawing.frame(projection.place(), scale, style.frame);
}

void add_close_up_marks(Drawing& drawing, const Projection& projection, const Style& style, double scale) {
  drawing.frame(projection.place(), 1.5 * scale, style.highlight);
  add_scale_bar_inside(drawing, projection, style, scale);
}

namespace {

void add_scalar_bar(Drawing& drawing, const ComparisonLayout& layout, const ColourScale& colours,
                    const Style& style) {
  const PixelRect& bar = layout.scalar_bar;
  const double size = 13 * layout.scale;
  const int steps = static_cast<int>(bar.height);
  for (int i = 0; i < steps; ++i) {
    const double value = colours.to + (colours.from - colours.to) * (i + 0.5) / steps;
    drawing.fill({bar.left, bar.top + i, bar.width, 1}, colours.at(value));
  }
  const Ticks ticks =
      round_ticks(colours.from, colours.to, std::max(2, static_cast<int>(bar.height / (44 * layout.scale))));
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double y =
        bar.bottom() - (ticks.values[i] - colours.from) / (colours.to - colours.from) * bar.height;
    drawing.fill({bar.right(), y - layout.scale / 2, 5 * layout.scale, layout.scale}, style.faint_text);
    drawing.add(TextMark{{bar.right() + 10 * layout.scale, y},
                         ticks.labels[i],
                         size,
                         style.faint_text,
                         AlignX::kLeft,
                         AlignY::kMiddle});
  }
}

void add_classes(Drawing& drawing, const ComparisonLayout& layout, std::span<const ColourClass> classes,
                 const Style& style) {
  const double size = 13 * layout.scale, chip = std::round(12 * layout.scale);
  double top = layout.scalar_bar.top;
  for (const ColourClass& one : classes) {
    drawing.fill({layout.scalar_bar.left, std::round(top), chip, chip}, one.colour);
    drawing.add(TextMark{{layout.scalar_bar.left + chip + 7 * layout.scale, top + chip / 2},
                         one.name,
                         size,
                         style.text,
                         AlignX::kLeft,
                         AlignY::kMiddle});
    top += 24 * layout.scale;
  }
}

}  // namespace

void add_legend(Drawing& drawing, const ComparisonLayout& layout, const Colouring& colouring,
                const Style& style) {
  const double size = 13 * layout.scale;
  const double title_up = (colouring.unit.empty() ? 8 : 24) * layout.scale;
  const PixelPoint at{layout.scalar_bar.left, layout.scalar_bar.top};
  drawing.add(TextMark{
      {at.x, at.y - title_up}, colouring.title, size, style.faint_text, AlignX::kLeft, AlignY::kBottom});
  if (!colouring.unit.empty()) {
    drawing.add(TextMark{{at.x, at.y - 8 * layout.scale},
                         "[" + colouring.unit + "]",
                         size,
                         style.faint_text,
                         AlignX::kLeft,
                         AlignY::kBottom});
  }
  if (colouring.classes.empty()) {
    add_scalar_bar(drawing, layout, colouring.scale, style);
  } else {
    add_classes(drawing, layout, colouring.classes, style);
  }
}

void add_footer(Drawing& drawing, const ComparisonLayout& layout, double width_px, const Style& style) {
  const double size = 13 * layout.scale;
  drawing.add(TextMark{layout.footer, "t_motor = t_laser + offset", size, style.faint_text});
  drawing.add(TextMark{{width_px - layout.margin, layout.footer.y},
                       "sweepscope " SWEEPSCOPE_VERSION,
                       size,
                       style.faint_text,
                       AlignX::kRight});
}

void add_no_points(Drawing& drawing, const ComparedMap& map, const PixelRect& place,
                   std::span<const HeightRange> slabs, const Style& style, double scale) {
  std::vector<std::string> words{"The map has no points."};
  if (map.cloud && !map.cloud->empty()) {
    words = {"None of the map's points is at the heights shown:", describe_slabs(slabs)};
  }
  drawing.fill(place, style.panel);
  drawing.frame(place, scale, style.frame);
  add_words(drawing, place, "Nothing to show", words, style, scale);
}

void add_no_curve(Drawing& drawing, const PixelRect& place, const Estimate& estimate, const Style& style,
                  double scale) {
  drawing.fill(place, style.panel);
  drawing.frame(place, scale, style.frame);
  constexpr std::size_t kMaxReasons = 4;
  std::vector<std::string> lines = estimate.reasons();
  lines.resize(std::min(kMaxReasons, lines.size()));
  for (std::string& line : lines) line = with_plus_minus_sign(line);
  if (lines.empty()) lines.push_back("The estimate holds no criterion at any offset.");
  add_words(drawing, place, "No curve over the offset", lines, style, scale);
}

}  // namespace sweepscope
