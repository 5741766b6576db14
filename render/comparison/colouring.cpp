#include "render/comparison/colouring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/map/surfaces/cloud_distance.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "core/numbers.hpp"
#include "core/parallel.hpp"

namespace sweepscope {
namespace {

constexpr std::array<std::string_view, 7> kNames{"elevation", "intensity", "time",    "direction",
                                                 "features",  "blur",      "distance"};
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
constexpr Colour kOrange{242, 180, 41}, kBlue{58, 146, 214}, kGrey{104, 110, 118};
// Not those of the compared maps, which stand beside them.
constexpr Colour kViolet{176, 122, 226}, kGreen{64, 190, 148};

template <typename ValueOf>
std::vector<float> each_point(const ComparedMap& map, ValueOf value_of) {
  std::vector<float> values(map.size());
  for_each_index(values.size(),
                 [&](std::size_t i) { values[i] = static_cast<float>(value_of((*map.cloud)[i])); });
  return values;
}

std::vector<float> in_millimetres(std::vector<float> metres) {
  for (float& value : metres) value *= 1e3F;
  return metres;
}

Result<std::vector<float>> feature_values(const ComparedMap& map) {
  if (map.feature_kinds.size() != map.size()) {
    return failure(
        ExitCode::kWrongUsage,
        "--colour-by features needs a recording: a map file does not say which points are features");
  }
  std::vector<float> values;
  for (const FeatureKind kind : map.feature_kinds) values.push_back(static_cast<float>(kind));
  return values;
}

Result<std::vector<float>> distance_values(const ComparedMap& map, const ComparedMap* other) {
  if (other == nullptr) return failure(ExitCode::kWrongUsage, "--colour-by distance needs at least two maps");
  if (map.size() == 0 || other->size() == 0) return std::vector<float>(map.size(), kNoValue);
  return in_millimetres(distances_to_m(*map.cloud, *other->cloud, {}));
}

std::vector<float> thickness_values(ComparedMap map) {
  measure_thickness(map);
  std::vector<float> values;
  if (!map.thickness) return values;
  for (const LocalSurface& surface : map.thickness->surfaces) values.push_back(surface.thickness_m);
  return in_millimetres(std::move(values));
}

/// Bands of the table, one for each class, for the values 0, 1, 2, ...
void set_classes(Colouring& colouring, std::vector<ColourClass> classes) {
  const std::size_t count = classes.size();
  colouring.scale.from = -0.5;
  colouring.scale.to = static_cast<double>(count) - 0.5;
  ColourTable& table = colouring.scale.table;
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = classes[i * count / table.size()].colour;
  colouring.classes = std::move(classes);
}

void set_titles(Colouring& colouring, ColourBy by) {
  switch (by) {
    case ColourBy::kElevation:
      colouring.title = "elevation", colouring.unit = "m";
      return;
    case ColourBy::kIntensity:
      colouring.title = "intensity";
      return;
    case ColourBy::kTime:
      colouring.title = "time", colouring.unit = "s";
      return;
    case ColourBy::kBlur:
      colouring.title = "thickness", colouring.unit = "mm";
      return;
    case ColourBy::kDistance:
      colouring.title = "distance", colouring.unit = "mm";
      return;
    case ColourBy::kDirection:
      colouring.title = "sweep";
      set_classes(colouring, {{"one way", kViolet}, {"back", kGreen}});
      return;
    case ColourBy::kFeatures:
      colouring.title = "features";
      set_classes(colouring, {{"none", kGrey}, {"edge", kOrange}, {"plane", kBlue}});
      return;
  }
}

/// The values' range without the outermost of them, which would take the colours from the rest.
ValueRange range_of(ColourBy by, std::span<const std::span<const float>> values) {
  std::vector<float> all;
  for (const auto& part : values) {
    std::copy_if(part.begin(), part.end(), std::back_inserter(all), [](float v) { return std::isfinite(v); });
  }
  if (all.empty()) return {};
  const auto at = [&](double fraction) { return static_cast<double>(quantile(all, fraction)); };
  // Lengths begin at nothing: dark is sharp, in every picture.
  if (by == ColourBy::kBlur) return {0, std::clamp(at(0.9), 30.0, 300.0)};
  if (by == ColourBy::kDistance) return {0, std::max(10.0, at(0.98))};
  const double from = at(0.005);
  return {from, at(0.995)};
}

void leave_out_absent_classes(Colouring& colouring, std::span<const std::span<const float>> values) {
  std::vector<bool> present(colouring.classes.size(), false);
  for (const auto& part : values) {
    for (const float value : part) {
      if (value >= 0 && value < static_cast<float>(present.size()))
        present[static_cast<std::size_t>(value)] = true;
    }
  }
  for (std::size_t i = present.size(); i-- > 0;) {
    if (!present[i]) colouring.classes.erase(colouring.classes.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

std::span<const std::string_view> colour_by_names() {
  return kNames;
}

Result<ColourBy> colour_by(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found != kNames.end()) return static_cast<ColourBy>(found - kNames.begin());
  return failure(ExitCode::kWrongUsage, fmt::format("Points cannot be coloured by \"{}\"; there are {}", name,
                                                    fmt::join(kNames, ", ")));
}

Result<std::vector<float>> colour_values(const ComparedMap& map, const ComparedMap* other, ColourBy by) {
  const double begin_s = map.size() > 0 ? map.cloud->front().time_s : 0;
  switch (by) {
    case ColourBy::kElevation:
      return each_point(map, [](const MapPoint& p) { return p.z; });
    case ColourBy::kIntensity:
      return each_point(map, [](const MapPoint& p) { return p.intensity; });
    case ColourBy::kTime:
      return each_point(map, [&](const MapPoint& p) { return p.time_s - begin_s; });
    case ColourBy::kDirection:
      return each_point(map, [](const MapPoint& p) { return p.sweep % 2; });
    case ColourBy::kFeatures:
      return feature_values(map);
    case ColourBy::kBlur:
      return thickness_values(map);
    case ColourBy::kDistance:
      return distance_values(map, other);
  }
  return std::vector<float>(map.size(), kNoValue);
}

Result<Colouring> make_colouring(ColourBy by, std::string_view table,
                                 std::span<const std::span<const float>> values,
                                 const std::optional<ValueRange>& range) {
  const auto colours = colour_table(table);
  if (!colours) return tl::unexpected(colours.error());
  Colouring colouring;
  colouring.scale.table = *colours;
  const ValueRange shown = range ? *range : range_of(by, values);
  colouring.scale.from = shown.from;
  colouring.scale.to = shown.to;
  set_titles(colouring, by);
  leave_out_absent_classes(colouring, values);
  return colouring;
}

}  // namespace sweepscope
