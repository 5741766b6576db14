#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "render/charts/ticks.hpp"
#include "render/figures/figure_pictures.hpp"

namespace sweepscope {
namespace {

constexpr Colour kEdge{214, 122, 0}, kPlane{0, 114, 178};

/// The scanner's plane in a part of the picture: x (forward) to the right, y (left) up, the same scale on
/// both axes.
struct PlaneAxes {
  PixelRect plot;
  double from_x = 0, from_y = 0, px_per_m = 1;

  PixelPoint operator()(double x_m, double y_m) const {
    return {plot.left + (x_m - from_x) * px_per_m, plot.bottom() - (y_m - from_y) * px_per_m};
  }
};

PlaneAxes fit_axes(std::span<const ScanPoint> scan, const PixelRect& room) {
  constexpr double kPad = 0.04;
  Eigen::AlignedBox2d box(Eigen::Vector2d(0, 0));  // with the scanner itself
  for (const ScanPoint& point : scan) box.extend(point.p_in_laser_m.cast<double>());
  const Eigen::Vector2d size = (box.sizes() * (1 + 2 * kPad)).cwiseMax(1.0);
  const double px_per_m = std::min(room.width / size.x(), room.height / size.y());
  const double width = size.x() * px_per_m, height = size.y() * px_per_m;
  const Eigen::Vector2d from = box.center() - size / 2;
  return {{room.left + std::floor((room.width - width) / 2),
           room.top + std::floor((room.height - height) / 2), width, height},
          from.x(),
          from.y(),
          px_per_m};
}

void add_axes(Page& page, const PlaneAxes& axes) {
  Drawing& marks = page.picture.marks;
  const double size = 11 * page.scale, gap = 6 * page.scale;
  const PixelRect& plot = axes.plot;
  marks.fill(plot, page.style.panel);
  const int max_x = std::max(2, static_cast<int>(plot.width / (48 * page.scale))),
            max_y = std::max(2, static_cast<int>(plot.height / (36 * page.scale)));
  const Ticks xs = round_ticks(axes.from_x, axes.from_x + plot.width / axes.px_per_m, max_x);
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double x = axes(xs.values[i], 0).x;
    marks.line({x, plot.top}, {x, plot.bottom()}, page.scale, page.style.grid);
    marks.add(TextMark{
        {x, plot.bottom() + gap}, xs.labels[i], size, page.style.faint_text, AlignX::kCentre, AlignY::kTop});
  }
  const Ticks ys = round_ticks(axes.from_y, axes.from_y + plot.height / axes.px_per_m, max_y);
  for (std::size_t i = 0; i < ys.values.size(); ++i) {
    const double y = axes(0, ys.values[i]).y;
    marks.line({plot.left, y}, {plot.right(), y}, page.scale, page.style.grid);
    marks.add(TextMark{
        {plot.left - gap, y}, ys.labels[i], size, page.style.faint_text, AlignX::kRight, AlignY::kMiddle});
  }
  marks.add(TextMark{{plot.left + plot.width / 2, plot.bottom() + gap + 1.5 * size},
                     "x of the scanner's plane, forward [m]",
                     size,
                     page.style.text,
                     AlignX::kCentre,
                     AlignY::kTop});
  marks.add(TextMark{{plot.left, plot.top - gap}, "y, to the left [m]", size, page.style.text});
  marks.frame(plot, page.scale, page.style.frame);
}

void add_point(Drawing& marks, PixelPoint at, FeatureKind kind, Colour faint, double scale) {
  const auto square = [&](double half, Colour colour) {
    marks.fill({at.x - half, at.y - half, 2 * half, 2 * half}, colour);
  };
  if (kind == FeatureKind::kNone) square(0.9 * scale, faint);
  if (kind == FeatureKind::kPlane) square(2.4 * scale, kPlane);
  if (kind != FeatureKind::kEdge) return;
  const double r = 4.4 * scale;  // another shape, for readers who cannot distinguish the colours
  marks.add(PolygonMark{{{at.x - r, at.y}, {at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}}, kEdge});
}

void add_legend(Page& page, const std::array<std::size_t, 3>& counts, double right, double baseline) {
  const double size = 12 * page.scale;
  const std::array<std::string, 3> names{"other points", "edge points", "plane points"};
  for (const std::size_t kind : {0U, 2U, 1U}) {
    const std::string text = fmt::format("{} ({})", names[kind], counts[kind]);
    right -= text_width_px(text, size);
    page.picture.marks.add(TextMark{{right, baseline}, text, size, page.style.text});
    right -= 10 * page.scale;
    add_point(page.picture.marks, {right, baseline - 0.36 * size}, static_cast<FeatureKind>(kind),
              page.style.faint_text, page.scale);
    right -= 16 * page.scale;
  }
}

}  // namespace

Picture scan_picture(std::span<const ScanPoint> scan, const ComparisonOptions& look) {
  Page page = make_page(look);
  const PixelRect room{page.room.left + 34 * page.scale, page.room.top + 24 * page.scale,
                       page.room.width - 34 * page.scale, page.room.height - 66 * page.scale};
  const PlaneAxes axes = fit_axes(scan, room);
  add_axes(page, axes);
  std::array<std::size_t, 3> counts{};
  for (const FeatureKind layer : {FeatureKind::kNone, FeatureKind::kPlane, FeatureKind::kEdge}) {
    for (const ScanPoint& point : scan) {
      if (point.kind != layer) continue;
      const auto at =
          axes(static_cast<double>(point.p_in_laser_m.x()), static_cast<double>(point.p_in_laser_m.y()));
      add_point(page.picture.marks, at, layer, page.style.faint_text, page.scale);
      ++counts[static_cast<std::size_t>(layer)];
    }
  }
  const PixelPoint scanner = axes(0, 0);
  const double r = 5 * page.scale;
  page.picture.marks.add(PolygonMark{
      {{scanner.x + r, scanner.y}, {scanner.x - r, scanner.y - r}, {scanner.x - r, scanner.y + r}},
      page.style.text});
  add_legend(page, counts, page.room.right(), page.room.top + 12 * page.scale);
  return std::move(page.picture);
}

}  // namespace sweepscope
