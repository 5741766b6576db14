#include "ui/panes/closer.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/map/feature_points.hpp"
#include "render/charts/ticks.hpp"
#include "ui/host/paint.hpp"
#include "ui/model/wall_profile.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

const Profile& profile_now(const PaneContext& context, Side side, const CrossSection& section) {
  Transient::KnownProfile& known = context.transient.profiles[static_cast<std::size_t>(side)];
  const Pane& pane = context.explorer.pane(side);
  const PlacedCloudPtr& cloud = pane.full ? pane.full : pane.coarse;
  const Settings& s = context.settings();
  const std::array<double, 4> line{s.profile_from_m.x(), s.profile_from_m.y(), s.profile_to_m.x(),
                                   s.profile_to_m.y()};
  if (known.cloud != cloud || known.line != line) {
    known.cloud = cloud;
    known.line = line;
    known.profile = cloud ? profile_of(*cloud, section) : Profile();
  }
  return known.profile;
}

/// In the middle of a place, in as many lines as it takes.
void hint(const PaneContext& context, const PixelRect& place, const char* text) {
  ImFont* font = context.fonts.nearest(context.px(13), false).font;
  const float wrap_px = static_cast<float>(place.width) - context.pxf(16);
  const ImVec2 size = font->CalcTextSizeA(font->FontSize, wrap_px, wrap_px, text);
  const ImVec2 at{std::round(static_cast<float>(place.left + place.width / 2) - size.x / 2),
                  std::round(static_cast<float>(place.top + place.height / 2) - size.y / 2)};
  ImGui::GetWindowDrawList()->AddText(font, font->FontSize, at, to_imgui(context.style.faint_text), text,
                                      nullptr, wrap_px);
}

/// The scanner's plane in a rectangle: x forward to the right, y to the left upwards, the same scale on both
/// axes.
struct PlaneView {
  PixelRect plot;
  Eigen::AlignedBox2d box;
  double px_per_m = 1;

  PixelPoint operator()(double x_m, double y_m) const {
    return {plot.left + plot.width / 2 + (x_m - box.center().x()) * px_per_m,
            plot.top + plot.height / 2 - (y_m - box.center().y()) * px_per_m};
  }
};

PlaneView fit(std::span<const ScanPoint> points, const PixelRect& plot) {
  PlaneView view{plot, Eigen::AlignedBox2d(Eigen::Vector2d(-0.5, -0.5), Eigen::Vector2d(0.5, 0.5)), 1};
  for (const ScanPoint& point : points) view.box.extend(point.p_in_laser_m.cast<double>());
  view.px_per_m = 0.92 * std::min(plot.width / view.box.sizes().x(), plot.height / view.box.sizes().y());
  return view;
}

void add_grid(Drawing& drawing, const PlaneView& view, const PaneContext& context) {
  drawing.fill(view.plot, context.style.panel);
  const double half_x = view.plot.width / 2 / view.px_per_m, half_y = view.plot.height / 2 / view.px_per_m;
  const Eigen::Vector2d centre = view.box.center();
  const Ticks xs = round_ticks(centre.x() - half_x, centre.x() + half_x,
                               static_cast<int>(view.plot.width / context.px(60)) + 2);
  for (std::size_t i = 0; i < xs.values.size(); ++i) {
    const double x = view(xs.values[i], 0).x;
    drawing.line({x, view.plot.top}, {x, view.plot.bottom()}, context.scale, context.style.grid);
    drawing.add(TextMark{{x, view.plot.bottom() + context.px(5)},
                         xs.labels[i] + " m",
                         context.px(11),
                         context.style.faint_text,
                         AlignX::kCentre,
                         AlignY::kTop});
  }
  const Ticks ys = round_ticks(centre.y() - half_y, centre.y() + half_y,
                               static_cast<int>(view.plot.height / context.px(50)) + 1);
  for (const double value : ys.values) {
    const double y = view(0, value).y;
    drawing.line({view.plot.left, y}, {view.plot.right(), y}, context.scale, context.style.grid);
  }
}

void add_point(Drawing& drawing, PixelPoint at, FeatureKind kind, double scale) {
  const auto square = [&](double half) {
    drawing.fill({at.x - half, at.y - half, 2 * half, 2 * half},
                 kind == FeatureKind::kNone ? Colour{128, 138, 152} : colour_of_feature(kind));
  };
  if (kind == FeatureKind::kNone) return square(0.8 * scale);
  if (kind == FeatureKind::kPlane) return square(2.2 * scale);
  const double r = 4.2 * scale;  // another shape, for readers who cannot distinguish the colours
  drawing.add(PolygonMark{{{at.x - r, at.y}, {at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}},
                          colour_of_feature(kind)});
}

/// From the left, below the title.
void add_legend(Drawing& drawing, const PaneContext& context, PixelPoint at, std::size_t edges,
                std::size_t planes) {
  for (const auto& [kind, words] : {std::pair{FeatureKind::kEdge, fmt::format("{} edge points", edges)},
                                    std::pair{FeatureKind::kPlane, fmt::format("{} plane points", planes)}}) {
    add_point(drawing, {at.x + context.px(4), at.y - context.px(4)}, kind, context.scale);
    at.x += context.px(14);
    drawing.add(TextMark{at, words, context.px(11), context.style.faint_text});
    at.x += text_width_px(words, context.px(11)) + context.px(18);
  }
}

void scrubber(const PaneContext& context, const PixelRect& place) {
  const auto& scans = context.explorer.loaded()->recording.scans;
  const int last = static_cast<int>(scans.size()) - 1;
  int scan = std::clamp(static_cast<int>(context.settings().scan), 0, last);
  ImGui::SetCursorScreenPos(corner(place));
  ImGui::SetNextItemWidth(static_cast<float>(place.width));
  const std::string format =
      fmt::format("scan %d of {}, {:.2f} s", scans.size(),
                  scans[static_cast<std::size_t>(scan)].first_beam_s - scans.front().first_beam_s);
  const bool moved = ImGui::SliderInt("##scan", &scan, 0, last, format.c_str());
  context.anchor_last("scan");
  if (ImGui::IsItemActivated()) context.begin_gesture();
  if (moved)
    context.perform(Call{find_command("scan"), {static_cast<double>(scan)}}, context.transient.gesture);
}

}  // namespace

void draw_profile_chart(const PaneContext& context, const PixelRect& place) {
  const auto section = section_of(context.settings());
  if (!section)
    return hint(context, place, "Draw a line across a wall, on either map, to compare its width in both.");
  std::string unfinished;
  for (const Side side : kBothSides) {
    const Pane& pane = context.explorer.pane(side);
    if (pane.state != PaneState::kSolved && pane.state != PaneState::kEmpty) unfinished = "previews";
    if (!pane.full) unfinished = "thinned points";
  }
  const Chart chart =
      profile_chart(profile_now(context, Side::kA, *section), profile_now(context, Side::kB, *section),
                    context.settings(), unfinished, context.style);
  const bool any = std::any_of(chart.series.begin(), chart.series.end(),
                               [](const ChartSeries& s) { return !s.x.empty(); });
  if (!any) return hint(context, place, "No points lie along the line.");
  Drawing drawing;
  add_chart(drawing, place, chart, context.style, context.scale * 0.86);
  paint(*ImGui::GetWindowDrawList(), drawing, context.fonts);
  context.anchor("profile", place);
}

void draw_scan_view(const PaneContext& context, const PixelRect& place) {
  const FeatureSet* features = context.explorer.loaded()->prepared.features.get();
  if (features == nullptr) return hint(context, place, "Picking edge and plane points …");
  const Loaded& loaded = *context.explorer.loaded();
  const auto scan = static_cast<std::size_t>(
      std::clamp(context.settings().scan, 0.0, static_cast<double>(loaded.recording.scans.size() - 1)));
  const std::vector<ScanPoint> points = scan_points(loaded.recording, *features, scan);
  const double bar = context.px(26), above = context.px(40), labels = context.px(22);
  const PixelRect plot{place.left, place.top + above, place.width, place.height - above - labels - bar};
  const PlaneView view = fit(points, plot);
  Drawing drawing;
  add_grid(drawing, view, context);
  std::size_t edges = 0, planes = 0;
  for (const FeatureKind kind : {FeatureKind::kNone, FeatureKind::kPlane, FeatureKind::kEdge}) {
    for (const ScanPoint& point : points) {
      if (point.kind != kind) continue;
      edges += kind == FeatureKind::kEdge ? 1 : 0;
      planes += kind == FeatureKind::kPlane ? 1 : 0;
      add_point(
          drawing,
          view(static_cast<double>(point.p_in_laser_m.x()), static_cast<double>(point.p_in_laser_m.y())),
          kind, context.scale);
    }
  }
  const PixelPoint scanner = view(0, 0);
  drawing.fill({scanner.x - context.px(3), scanner.y - context.px(3), context.px(6), context.px(6)},
               context.style.highlight);
  drawing.frame(plot, context.scale, context.style.frame);
  drawing.add(TextMark{{place.left, place.top + context.px(13)},
                       "Scan, in the scanner's plane",
                       context.px(13),
                       context.style.text});
  add_legend(drawing, context, {place.left, place.top + context.px(31)}, edges, planes);
  paint(*ImGui::GetWindowDrawList(), drawing, context.fonts);
  scrubber(context, {place.left, place.bottom() - bar + context.px(4), place.width, bar});
}

}  // namespace sweepscope::ui
