#include "render/page/live_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/io/printable_text.hpp"
#include "core/offset/search_window.hpp"
#include "render/charts/curve_charts.hpp"
#include "render/comparison/comparison_points.hpp"
#include "render/page/html.hpp"
#include "render/page/packed_map.hpp"
#include "render/page/page_files.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

double in_ms(double time_s) {
  return std::round(time_s * 1e9) * 1e-6;
}

Json json_of(const std::vector<HeightRange>& slabs) {
  Json list = Json::array();
  const auto bound = [](double height_m) { return std::isfinite(height_m) ? Json(height_m) : Json(nullptr); };
  for (const HeightRange& slab : slabs) list.push_back({bound(slab.from_m), bound(slab.to_m)});
  return list;
}

std::string table_bytes(const ColourTable& table) {
  std::string bytes;
  for (const Colour& colour : table)
    for (const std::uint8_t channel : {colour.red, colour.green, colour.blue, colour.alpha})
      bytes += static_cast<char>(channel);
  return bytes;
}

/// What colours the points, as make_colouring() has it for the maps at first.
Result<Json> colouring_json(const LiveMap& live, ColourBy by, const std::vector<HeightRange>& slabs) {
  std::vector<SlabPoints> shown;
  std::vector<std::span<const float>> values;
  for (const ComparedMap& map : live.still) {
    const auto of_map = colour_values(map, nullptr, by);
    if (!of_map) return tl::unexpected(of_map.error());
    shown.push_back(points_in_slabs(map, *of_map, slabs));
  }
  for (const SlabPoints& points : shown) values.push_back(points.points.values);
  return make_colouring(by, "viridis", values, std::nullopt).map([&](const Colouring& colouring) {
    Json classes = Json::array();
    for (const ColourClass& one : colouring.classes) classes.push_back(one.name);
    return Json{{"by", colour_by_names()[static_cast<std::size_t>(by)]},
                {"title", colouring.title},
                {"unit", colouring.unit},
                {"from", colouring.scale.from},
                {"to", colouring.scale.to},
                {"classes", classes},
                {"table", html::base64(table_bytes(colouring.scale.table))}};
  });
}

Result<Json> colourings_json(const LiveMap& live, const std::vector<HeightRange>& slabs, bool intensity) {
  std::vector<ColourBy> all{ColourBy::kElevation, ColourBy::kDirection, ColourBy::kTime};
  if (intensity) all.push_back(ColourBy::kIntensity);
  Json list = Json::array();
  for (const ColourBy by : all) {
    auto one = colouring_json(live, by, slabs);
    if (!one) return one;
    list.push_back(std::move(*one));
  }
  return list;
}

std::vector<SlabPoints> shown_in(const std::vector<HeightRange>& slabs, const LiveMap& live) {
  std::vector<SlabPoints> shown;
  for (const ComparedMap& map : live.still)
    shown.push_back(points_in_slabs(map, std::vector<float>(map.size()), slabs));
  return shown;
}

/// The space that points fill, without stray ones.
std::array<Bounds, 3> box_of(const std::vector<SlabPoints>& shown) {
  constexpr double kOutermost = 0.001;
  return {bounds_of(shown, 0, kOutermost), bounds_of(shown, 1, kOutermost), bounds_of(shown, 2, kOutermost)};
}

Json json_of(const std::array<Bounds, 3>& box) {
  const auto& [x_m, y_m, z_m] = box;
  return {{x_m.from, y_m.from, z_m.from}, {x_m.to, y_m.to, z_m.to}};
}

/// Where the two maps differ most, seen from above.
Region close_up(const std::vector<SlabPoints>& shown, const std::array<Bounds, 3>& box) {
  const double height_m = close_up_height_m(std::max(box[0].to - box[0].from, box[1].to - box[1].from));
  return find_close_up(shown, height_m, height_m);
}

Json json_of(const Chart& chart) {
  Json series = Json::array(), markers = Json::array(), verticals = Json::array();
  for (const ChartSeries& one : chart.series) {
    Json y = Json::array();
    for (const auto& value : one.y) y.push_back(value ? Json(*value) : Json(nullptr));
    series.push_back({{"name", one.name}, {"x", one.x}, {"y", y}, {"dashed", one.dashed}});
  }
  for (const ChartMarker& marker : chart.markers) markers.push_back({marker.x, marker.y});
  for (const ChartVertical& line : chart.verticals)
    verticals.push_back({{"x", line.x}, {"label", line.label}});
  return {{"title", chart.title},
          {"series", series},
          {"markers", markers},
          {"verticals", verticals},
          {"with_zero", chart.with_zero}};
}

Json charts_json(const LiveMap& live) {
  Json list = Json::array();
  if (!live.criteria) return list;
  for (const Chart& chart : curve_charts(*live.criteria, {}, style_of(Background::kWhite)))
    list.push_back(json_of(chart));
  return list;
}

std::string label_of(const ComparedMap& map) {
  return map.label.empty() ? "" : html::escape(map.label);
}

/// "300,000"
std::string grouped(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::ptrdiff_t at = std::ssize(text) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

std::string what_is_drawn(const TurnableMap& map) {
  const std::string points =
      map.beams.size() == map.usable_beams
          ? fmt::format("all {} measured points", grouped(map.usable_beams))
          : fmt::format(
                "{} of {} measured points, chosen evenly in space where the map is blurred, so that "
                "blurred places keep theirs",
                grouped(map.beams.size()), grouped(map.usable_beams));
  const char* path = map.moving
                         ? "They follow the trajectory that was solved together with the answer; it does "
                           "not change with the offset."
                         : "The rig stood still: the map is exact at every offset.";
  return fmt::format(
      "Drawn in your browser: {}, each turned by the motor's angle at its own time plus the "
      "offset. {}",
      points, path);
}

}  // namespace

OffsetSpan live_span(const PreparedRecording& prepared, double a_s, double b_s) {
  constexpr double kMargin_s = 0.010;
  const double middle_s = (a_s + b_s) / 2, apart_s = std::abs(b_s - a_s) / 2;
  const double most_s = std::max(search_scale(prepared.motor).max_half_width_s, apart_s);
  const double half_s = std::min(apart_s + kMargin_s, most_s);
  return {middle_s - half_s, middle_s + half_s};
}

LiveMap live_map(const PreparedRecording& prepared, const std::vector<SweepPose>* path,
                 std::vector<ComparedMap> still, std::optional<Estimate> criteria, std::size_t points) {
  LiveMap live;
  live.offset_s = {still.at(0).offset_s.value(), still.at(1).offset_s.value()};
  live.span = live_span(prepared, live.offset_s[0], live.offset_s[1]);
  live.map = turnable_map(prepared, path, live.span.from_s, live.span.to_s);
  live.map = with_beams(live.map, evenly_in_space(positions_at(live.map, live.offset_s[0]), points));
  live.still = std::move(still);
  live.criteria = std::move(criteria);
  return live;
}

std::string live_map_part(const LiveMap& live) {
  return fmt::format(
      "<section id=\"live\" hidden data-label-a=\"{}\" data-label-b=\"{}\">\n"
      "<h2>The map at any offset</h2>\n<div id=\"live-bar\"></div>\n"
      "<div id=\"live-stage\"><canvas id=\"live-canvas\" tabindex=\"0\" aria-label=\"Maps A and B from the "
      "measured beams\"></canvas></div>\n<div id=\"live-legend\"></div>\n"
      "<div id=\"live-charts\"></div>\n<p class=\"caption\">{}</p>\n</section>\n",
      label_of(live.still.at(0)), label_of(live.still.at(1)), what_is_drawn(live.map));
}

Result<std::string> live_map_data(const LiveMap& live) {
  const PackedMap packed = pack_map(live.map);
  Json head = Json::parse(packed.head_json);
  ComparisonOptions top, oblique;
  oblique.viewpoint = Viewpoint::kIsometric;
  const std::vector<HeightRange> top_slabs = choose_slabs(live.still, top),
                                 all_slabs = choose_slabs(live.still, oblique);
  auto colourings = colourings_json(live, top_slabs, !head["intensity_range"].is_null());
  if (!colourings) return tl::unexpected(colourings.error());
  head["offset_ms"] = {in_ms(live.offset_s[0]), in_ms(live.offset_s[1])};
  head["span_ms"] = {in_ms(live.span.from_s), in_ms(live.span.to_s)};
  head["slabs_m"] = {{"top", json_of(top_slabs)}, {"other", json_of(all_slabs)}};
  const std::vector<SlabPoints> top_points = shown_in(top_slabs, live);
  const auto top_box = box_of(top_points);
  head["box_m"] = {{"top", json_of(top_box)}, {"other", json_of(box_of(shown_in(all_slabs, live)))}};
  const Region differs = close_up(top_points, top_box);
  head["close_up"] = {{"centre_m", {differs.centre_m.x(), differs.centre_m.y()}},
                      {"height_m", differs.height_m}};
  head["colourings"] = std::move(*colourings);
  head["charts"] = charts_json(live);
  return html::json_block("live-head", json_text(std::move(head))) +
         html::data_block("live-data", packed.bytes) +
         fmt::format(
             "<script type=\"x-shader/x-vertex\" id=\"place-shader\">{}</script>\n"
             "<script type=\"x-shader/x-vertex\" id=\"draw-shader\">{}</script>\n",
             place_shader(), draw_shader());
}

}  // namespace sweepscope
