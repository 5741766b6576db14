#include "render/comparison_marks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/ticks.hpp"

namespace sweepscope {
namespace {

constexpr double kBodyPx = 14;

struct ScaleBar {
  double length_px = 0;
  std::string label;
};

/// A round length, about an eighth of the view.
ScaleBar scale_bar_of(const TopView& view, double scale) {
  const double length_m = round_length(view.metres_per_px * std::min(180 * scale, view.place.width * 0.2));
  return {length_m / view.metres_per_px,
          length_m >= 1 ? fmt::format("{:.0f} m", length_m) : fmt::format("{:.0f} cm", 100 * length_m)};
}

void add_bar(Drawing& drawing, PixelPoint left_end, double length_px, Colour colour, double scale) {
  const double tick = 6 * scale, width = std::max(1.0, std::round(2 * scale));
  drawing.fill({left_end.x, left_end.y - width, length_px, width}, colour);
  drawing.fill({left_end.x, left_end.y - tick, width, tick}, colour);
  drawing.fill({left_end.x + length_px - width, left_end.y - tick, width, tick}, colour);
}

/// Above the view at its right, where it hides no points.
void add_scale_bar_above(Drawing& drawing, const TopView& view, const Style& style, double scale) {
  const ScaleBar bar = scale_bar_of(view, scale);
  const double y = view.place.top - 12 * scale, left = view.place.right() - bar.length_px;
  add_bar(drawing, {left, y}, bar.length_px, style.text, scale);
  drawing.add(TextMark{{left - 9 * scale, y}, bar.label, kBodyPx * scale, style.text, AlignX::kRight});
}

/// At the view's lower left, on a ground that keeps it legible above points.
void add_scale_bar_inside(Drawing& drawing, const TopView& view, const Style& style, double scale) {
  const ScaleBar bar = scale_bar_of(view, scale);
  const double size = kBodyPx * scale, pad = 10 * scale, text_width = text_width_px(bar.label, size);
  const PixelRect ground{view.place.left + pad, view.place.bottom() - pad - size - 1.4 * pad,
                         bar.length_px + text_width + 3 * pad, size + 1.4 * pad};
  Colour veil = style.page;
  veil.alpha = 215;
  drawing.fill(ground, veil);
  const PixelPoint left_end{ground.left + pad, ground.bottom() - pad};
  add_bar(drawing, left_end, bar.length_px, style.text, scale);
  drawing.add(TextMark{{left_end.x + bar.length_px + pad, left_end.y}, bar.label, size, style.text});
}

/// The sensor's way as a thin line.
void add_path(Drawing& drawing, const TopView& view, std::span<const StampedPose> path, const Style& style,
              double scale) {
  constexpr double kLeastStep_px = 2;
  Colour colour = style.map_highlight;
  colour.alpha = 120;
  LineMark line{{}, 1.2 * scale, colour};
  const auto finish = [&] {
    if (line.points.size() > 1) drawing.add(line);
    line.points.clear();
  };
  for (const StampedPose& pose : path) {
    const PixelPoint at = view.to_px(pose.position_m.x(), pose.position_m.y());
    if (!view.place.contains(at)) {
      finish();
      continue;
    }
    const bool first = line.points.empty();
    if (first || std::hypot(at.x - line.points.back().x, at.y - line.points.back().y) >= kLeastStep_px) {
      line.points.push_back(at);
    }
  }
  finish();
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

std::string describe_slabs(std::span<const HeightRange> slabs) {
  std::string text;
  for (auto slab = slabs.rbegin(); slab != slabs.rend(); ++slab) {
    if (!text.empty()) text += ", ";
    text += describe_slab(*slab);
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

void add_overview_marks(Drawing& drawing, const TopView& view, std::span<const StampedPose> path, bool empty,
                        const Style& style, double scale) {
  if (!empty) {
    add_path(drawing, view, path, style, scale);
    add_scale_bar_above(drawing, view, style, scale);
  }
  drawing.frame(view.place, scale, style.frame);
}

void add_close_up_marks(Drawing& drawing, const TopView& overview, const TopView& close_up, bool empty,
                        const Style& style, double scale) {
  drawing.frame(close_up.place, empty ? scale : 1.5 * scale, empty ? style.frame : style.highlight);
  if (empty) return;
  add_scale_bar_inside(drawing, close_up, style, scale);
  const Eigen::Vector2d half = close_up.half_extent_m();
  const PixelPoint a = overview.to_px(close_up.centre_m.x() - half.x(), close_up.centre_m.y() - half.y());
  const PixelPoint b = overview.to_px(close_up.centre_m.x() + half.x(), close_up.centre_m.y() + half.y());
  const PixelRect& place = overview.place;
  const double left = std::clamp(std::min(a.x, b.x), place.left, place.right());
  const double right = std::clamp(std::max(a.x, b.x), place.left, place.right());
  const double top = std::clamp(std::min(a.y, b.y), place.top, place.bottom());
  const double bottom = std::clamp(std::max(a.y, b.y), place.top, place.bottom());
  drawing.frame({std::round(left), std::round(top), std::round(right - left), std::round(bottom - top)},
                1.5 * scale, style.map_highlight);
}

void add_scalar_bar(Drawing& drawing, const ComparisonLayout& layout, const ColourScale& colours,
                    const Style& style) {
  const PixelRect& bar = layout.scalar_bar;
  const double size = 13 * layout.scale;
  drawing.add(TextMark{{bar.left, bar.top - 24 * layout.scale},
                       "elevation",
                       size,
                       style.faint_text,
                       AlignX::kLeft,
                       AlignY::kBottom});
  drawing.add(TextMark{
      {bar.left, bar.top - 8 * layout.scale}, "[m]", size, style.faint_text, AlignX::kLeft, AlignY::kBottom});
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

void add_footer(Drawing& drawing, const ComparisonLayout& layout, double width_px, const Style& style) {
  const double size = 13 * layout.scale;
  drawing.add(TextMark{layout.footer, "t_motor = t_laser + offset", size, style.faint_text});
  drawing.add(TextMark{{width_px - layout.margin, layout.footer.y},
                       "sweepscope " SWEEPSCOPE_VERSION,
                       size,
                       style.faint_text,
                       AlignX::kRight});
}

void add_no_points(Drawing& drawing, const ComparedMap& map, const TopView& view,
                   std::span<const HeightRange> slabs, const Style& style, double scale) {
  std::vector<std::string> words{"The map has no points."};
  if (map.cloud && !map.cloud->empty()) {
    words = {"None of the map's points is at the heights shown:", describe_slabs(slabs)};
  }
  drawing.fill(view.place, style.panel);
  drawing.frame(view.place, scale, style.frame);
  add_words(drawing, view.place, "Nothing to show", words, style, scale);
}

void add_no_curve(Drawing& drawing, const PixelRect& place, const Estimate& estimate, const Style& style,
                  double scale) {
  drawing.fill(place, style.panel);
  drawing.frame(place, scale, style.frame);
  std::vector<std::string> lines(estimate.reasons.begin(),
                                 estimate.reasons.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(
                                                                4, estimate.reasons.size())));
  if (lines.empty()) lines.push_back("The estimate holds no criterion at any offset.");
  add_words(drawing, place, "No curve over the offset", lines, style, scale);
}

}  // namespace sweepscope
