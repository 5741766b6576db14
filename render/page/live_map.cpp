#include "render/page/live_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/io/printable_text.hpp"
#include "core/map/place_beams.hpp"
#include "core/offset/prepared/search_window.hpp"
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

/// Of each map, the points that are shown.
using ShownIndices = std::vector<std::vector<std::uint32_t>>;

/// What colours the points, as make_colouring() has it for the maps at first.
Result<Colouring> colouring_of(const LiveMap& live, ColourBy by, const ShownIndices& shown) {
  std::vector<std::vector<float>> of_maps;
  for (std::size_t m = 0; m < shown.size(); ++m) {
    const auto of_map = colour_values(live.still[m], nullptr, by);
    if (!of_map) return tl::unexpected(of_map.error());
    std::vector<float>& values = of_maps.emplace_back();
    values.reserve(shown[m].size());
    for (const std::uint32_t i : shown[m]) values.push_back((*of_map)[i]);
  }
  return make_colouring(by, "viridis", std::vector<std::span<const float>>(of_maps.begin(), of_maps.end()),
                        std::nullopt);
}

Json json_of(const Colouring& colouring, ColourBy by) {
  Json classes = Json::array();
  for (const ColourClass& one : colouring.classes)
    classes.push_back({{"name", one.name}, {"colour", {one.colour.red, one.colour.green, one.colour.blue}}});
  return {{"by", colour_by_names()[static_cast<std::size_t>(by)]},
          {"title", colouring.title},
          {"unit", colouring.unit},
          {"from", colouring.scale.from},
          {"to", colouring.scale.to},
          {"classes", classes},
          {"table", html::base64(table_bytes(colouring.scale.table))},
          {"given", Json::array()}};
}

/// The place of a value in the colouring's table.
std::uint8_t table_index(const ColourScale& scale, double value) {
  const double part = scale.to > scale.from ? (value - scale.from) / (scale.to - scale.from) : 0.5;
  return static_cast<std::uint8_t>(std::isnan(part) ? 0 : std::lround(255 * std::clamp(part, 0.0, 1.0)));
}

/// The colours that a page offers, and of those that it cannot compute itself an array of each beam's place
/// in the table. Such colourings list the arrays as `given`, with the offset that they hold for.
struct PageColours {
  Json colourings = Json::array();
  std::vector<NamedBytes> arrays;

  void add_given(Json& colouring, std::string name, Json offset_ms, std::vector<std::uint8_t> indices) {
    colouring["given"].push_back({{"array", name}, {"offset_ms", std::move(offset_ms)}});
    arrays.push_back({std::move(name), std::move(indices)});
  }
};

void add_intensity(PageColours& colours, const LiveMap& live, const Colouring& colouring) {
  if (!(colouring.scale.to > colouring.scale.from)) return;  // the laser has none
  Json one = json_of(colouring, ColourBy::kIntensity);
  std::vector<std::uint8_t> indices;
  for (const TurnableBeam& beam : live.map.beams)
    indices.push_back(table_index(colouring.scale, double(beam.intensity)));
  colours.add_given(one, "intensity", nullptr, std::move(indices));
  colours.colourings.push_back(std::move(one));
}

/// Four beams a byte.
void add_features(PageColours& colours, const LiveMap& live, const Colouring& colouring) {
  Json one = json_of(colouring, ColourBy::kFeatures);
  const std::vector<FeatureKind>& kinds = live.colours.kinds;
  std::vector<std::uint8_t> packed((kinds.size() + 3) / 4);
  for (std::size_t i = 0; i < kinds.size(); ++i)
    packed[i / 4] |= static_cast<std::uint8_t>(static_cast<unsigned>(kinds[i]) << 2 * (i % 4));
  colours.add_given(one, "features", nullptr, std::move(packed));
  colours.colourings.push_back(std::move(one));
}

/// Place 0 of the table is for what has no thickness.
void add_blur(PageColours& colours, const LiveMap& live, Colouring colouring) {
  colouring.scale.table[0] = colouring.scale.no_value;
  Json one = json_of(colouring, ColourBy::kBlur);
  for (const BeamBlur& blur : live.colours.blur) {
    std::vector<std::uint8_t> indices;
    for (const float thickness_m : blur.thickness_m) {
      const std::uint8_t index = table_index(colouring.scale, double(thickness_m * 1e3F));
      indices.push_back(std::isnan(thickness_m) ? std::uint8_t{0} : std::max(index, std::uint8_t{1}));
    }
    colours.add_given(one, "blur" + std::to_string(one["given"].size()), in_ms(blur.offset_s),
                      std::move(indices));
  }
  colours.colourings.push_back(std::move(one));
}

Result<PageColours> page_colours(const LiveMap& live, const std::vector<HeightRange>& slabs) {
  PageColours colours;
  ShownIndices shown;
  for (const ComparedMap& map : live.still) shown.push_back(indices_in_slabs(map, slabs));
  for (const ColourBy by : {ColourBy::kElevation, ColourBy::kDirection, ColourBy::kTime, ColourBy::kIntensity,
                            ColourBy::kFeatures, ColourBy::kBlur}) {
    const auto colouring = colouring_of(live, by, shown);
    if (!colouring) return tl::unexpected(colouring.error());
    if (by == ColourBy::kIntensity)
      add_intensity(colours, live, *colouring);
    else if (by == ColourBy::kFeatures)
      add_features(colours, live, *colouring);
    else if (by == ColourBy::kBlur)
      add_blur(colours, live, *colouring);
    else
      colours.colourings.push_back(json_of(*colouring, by));
  }
  return colours;
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
  for (const Chart& chart : live.charts) list.push_back(json_of(chart));
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

std::string what_is_drawn(const LiveMap& live) {
  const std::size_t drawn = live.map.beams.size();
  const std::string points =
      drawn == live.usable_beams
          ? fmt::format("all {} measured points", grouped(drawn))
          : fmt::format(
                "{} of {} measured points, chosen evenly in space in the blurred map, so that "
                "blurred places keep their points",
                grouped(drawn), grouped(live.usable_beams));
  const char* path = live.map.moving
                         ? "They follow the trajectory that was solved together with the answer; it does "
                           "not change with the offset."
                         : "The rig was stationary: the map is exact at every offset.";
  return fmt::format(
      "Drawn in your browser: {}, each turned by the motor's angle at its own time plus the "
      "offset. {}",
      points, path);
}

/// The beams that are drawn, of all that may be.
struct DrawnBeams {
  Beams beams;
  MapPath path;
  std::vector<std::uint32_t> chosen;

  std::vector<std::array<float, 3>> positions_m(double offset_s) const {
    return place_beams(beams, path, offset_s, chosen);
  }
};

/// The blur of the maps at first, and as far beyond B as A is before it.
std::vector<BeamBlur> blur_of(const DrawnBeams& drawn, const LiveMap& live, const Job& job) {
  // With more points, a third blur would take the page above 12 MB.
  constexpr std::size_t kMaxPointsOfThree = 400'000;
  std::vector<BeamBlur> blur;
  const auto add = [&](const ComparedMap& map) {
    blur.push_back(blur_of_beams(live.map, drawn.positions_m(*map.offset_s), map));
  };
  for (const ComparedMap& map : live.still) add(map);
  ComparedMap beyond;
  beyond.offset_s = 2 * live.offset_s[1] - live.offset_s[0];
  if (live.map.beams.size() <= kMaxPointsOfThree && *beyond.offset_s >= live.span.from_s &&
      *beyond.offset_s <= live.span.to_s) {
    beyond.cloud = map_along(*drawn.beams.recording, drawn.path, *beyond.offset_s).cloud;
    measure_thickness(beyond, job);
    add(beyond);
  }
  std::ranges::sort(blur, {}, &BeamBlur::offset_s);
  return blur;
}

BeamColours beam_colours(const FeatureSet& features, const DrawnBeams& drawn, const LiveMap& live,
                         const Job& job) {
  MapCloud times;
  for (const TurnableBeam& beam : live.map.beams) times.emplace_back().time_s = beam.time_s;
  return {feature_kinds(features, times), blur_of(drawn, live, job)};
}

/// `usable`: the number of beams to choose from.
DrawnBeams choose_beams(const Recording& recording, MapPath path, double offset_s, std::size_t points,
                        std::size_t usable, const Job& job) {
  constexpr std::size_t kMaxChoice = 4'000'000;
  DrawnBeams drawn{collect_beams(recording, path.used, 1 + usable / kMaxChoice), std::move(path), {}};
  drawn.chosen = evenly_in_space(place_beams(drawn.beams, drawn.path, offset_s, job), points);
  return drawn;
}

}  // namespace

OffsetSpan live_span(const PreparedRecording& prepared, double a_s, double b_s) {
  constexpr double kMargin_s = 0.010;
  const double middle_s = (a_s + b_s) / 2, apart_s = std::abs(b_s - a_s) / 2;
  const double max_s = std::max(search_scale(prepared.motor).max_half_width_s, apart_s);
  const double half_s = std::min(apart_s + kMargin_s, max_s);
  return {middle_s - half_s, middle_s + half_s};
}

LiveMap live_map(const PreparedRecording& prepared, std::shared_ptr<const SolvedWalk> walk,
                 std::vector<ComparedMap> still, std::optional<Estimate> criteria, std::size_t points,
                 const Job& job) {
  const Recording& recording = *prepared.recording;
  LiveMap live;
  live.offset_s = {still.at(0).offset_s.value(), still.at(1).offset_s.value()};
  live.span = live_span(prepared, live.offset_s[0], live.offset_s[1]);
  MapPath path = path_without_solving(prepared, scans_covered(recording, live.span.from_s, live.span.to_s));
  path.walk = std::move(walk);
  for (std::size_t i = 0; i < recording.scans.size(); ++i)
    if (path.used[i] != 0) live.usable_beams += usable_beams(recording, recording.scans[i]);
  const DrawnBeams drawn =
      choose_beams(recording, std::move(path), live.offset_s[0], points, live.usable_beams, job);
  if (job.cancelled()) return live;
  live.map = turnable_map(drawn.beams, drawn.path, drawn.chosen);
  for (ComparedMap& map : still) {
    measure_thickness(map, job);
    if (map.feature_kinds.empty()) map.feature_kinds = feature_kinds(*prepared.features, *map.cloud);
  }
  live.still = std::move(still);
  live.criteria = std::move(criteria);
  if (live.criteria) live.charts = curve_charts(*live.criteria, {}, style_of(Background::kWhite));
  live.colours = beam_colours(*prepared.features, drawn, live, job);
  return live;
}

std::string live_map_part(const LiveMap& live) {
  return fmt::format(
      "<section id=\"live\" hidden data-label-a=\"{}\" data-label-b=\"{}\">\n"
      "<h2>The map at any offset</h2>\n<div id=\"live-bar\"></div>\n"
      "<div id=\"live-stage\"><canvas id=\"live-canvas\" tabindex=\"0\" aria-label=\"Maps A and B from the "
      "measured beams\"></canvas></div>\n<div id=\"live-legend\"></div>\n"
      "<div id=\"live-charts\"></div>\n<p class=\"caption\">{}</p>\n</section>\n",
      label_of(live.still.at(0)), label_of(live.still.at(1)), what_is_drawn(live));
}

Result<std::string> live_map_data(const LiveMap& live) {
  ComparisonOptions top, oblique;
  oblique.viewpoint = Viewpoint::kIsometric;
  const std::vector<HeightRange> top_slabs = choose_slabs(live.still, top),
                                 all_slabs = choose_slabs(live.still, oblique);
  auto colours = page_colours(live, top_slabs);
  if (!colours) return tl::unexpected(colours.error());
  const PackedMap packed = pack_map(live.map, colours->arrays);
  Json head = Json::parse(packed.head_json);
  head["offset_ms"] = {in_ms(live.offset_s[0]), in_ms(live.offset_s[1])};
  head["span_ms"] = {in_ms(live.span.from_s), in_ms(live.span.to_s)};
  head["slabs_m"] = {{"top", json_of(top_slabs)}, {"other", json_of(all_slabs)}};
  const std::vector<SlabPoints> top_points = shown_in(top_slabs, live);
  const auto top_box = box_of(top_points);
  head["box_m"] = {{"top", json_of(top_box)}, {"other", json_of(box_of(shown_in(all_slabs, live)))}};
  const Region differs = close_up(top_points, top_box);
  head["close_up"] = {{"centre_m", {differs.centre_m.x(), differs.centre_m.y()}},
                      {"height_m", differs.height_m}};
  head["colourings"] = std::move(colours->colourings);
  const MapCloud& first = *live.still.front().cloud;
  head["time_origin_s"] = first.empty() ? 0.0 : first.front().time_s;
  head["charts"] = charts_json(live);
  return html::json_block("live-head", json_text(std::move(head))) +
         html::data_block("live-data", packed.bytes) +
         fmt::format(
             "<script type=\"x-shader/x-vertex\" id=\"place-shader\">{}</script>\n"
             "<script type=\"x-shader/x-vertex\" id=\"draw-shader\">{}</script>\n",
             place_shader(), draw_shader());
}

}  // namespace sweepscope
