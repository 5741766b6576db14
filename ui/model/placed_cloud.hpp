#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/map/feature_points.hpp"
#include "core/map/surfaces/surface_thickness.hpp"
#include "render/comparison/colouring.hpp"
#include "render/images/colour_table.hpp"
#include "render/pictures/live_view.hpp"
#include "ui/model/solved_map.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The part of a map that is shown, and its colours; derived from the settings.
struct CloudLook {
  ColourBy colouring = ColourBy::kElevation;
  std::string table = "viridis";
  double from = 0, to = 1;  // the values at the colour table's ends
  Heights heights = Heights::kSharp;
  double slab_from_m = 0, slab_to_m = 0;
  double time_from_s = 0, time_to_s = 0;
  Eigen::Vector3d box_from_m{0, 0, 0}, box_to_m{0, 0, 0};  // both the same: no box
  bool on_light = false;                                   // the ground behind the points

  bool operator==(const CloudLook&) const = default;
};

/// The colours of a table. On a light ground a table that ends in a bright yellow or in white stops before
/// it, or its greatest values could not be seen.
ColourTable shown_table(const std::string& name, bool on_light);

/// Points ready to be drawn, and the beam that each came from.
struct PlacedCloud {
  LivePointsPtr points = std::make_shared<LivePoints>();
  std::vector<std::uint32_t> beams;  // index into Beams
};
using PlacedCloudPtr = std::shared_ptr<const PlacedCloud>;

/// The placement of beams: along a map's path, with the motor angle of an offset.
struct Placement {
  LoadedPtr loaded;
  SolvedMapPtr map;
  double offset_s = 0;

  bool operator==(const Placement&) const = default;
};

/// Values of the beams, one for each of Beams; NaN if a beam has none.
using BeamValues = std::vector<float>;
using BeamValuesPtr = std::shared_ptr<const BeamValues>;

/// Whether a colouring's values are computed from all points together, which takes a second or more.
bool is_slow(ColourBy by);

/// The values of a slow colouring: the thickness in millimetres, or a FeatureKind as a number; and with the
/// thickness that of the whole map.
struct SlowValues {
  BeamValuesPtr values;
  std::optional<MapThickness> thickness;
};
/// If `job` is cancelled, values are missing.
SlowValues slow_values(const Placement& placement, ColourBy by, const FeatureSet* features, const Job& job);

/// `coarse`: only the chosen points. With `other`, points are coloured by their distance from that placement,
/// in millimetres, instead of by the look's colouring. `slow`: the values of the look's colouring if it is
/// slow; without them points are grey. If `job` is cancelled, points are missing.
PlacedCloud place_cloud(const Placement& placement, const CloudLook& look, bool coarse,
                        const Placement* other = nullptr, const BeamValues* slow = nullptr,
                        const Job& job = {});

/// The same for the given beams alone, in ascending order.
PlacedCloud place_chosen(const Placement& placement, const CloudLook& look,
                         const std::vector<std::uint32_t>& beams, const Placement* other = nullptr,
                         const BeamValues* slow = nullptr);

/// The range that nearly all distances between two placements of the chosen points lie in, from 0, in
/// millimetres.
double difference_span_mm(const Placement& placement, const Placement& other);

/// The laser's intensity of a beam; 0 if it has none.
double intensity_of(const Placement& placement, std::uint32_t beam);

/// The values at the ends of the colour table: the range of a colouring over both maps.
struct ColourSpan {
  double from = 0, to = 1;
};
ColourSpan colour_span(ColourBy by, const Loaded& loaded, const SolvedMap* a, const SolvedMap* b);

/// Of blur, over two maps: both the thinner and the thicker one are seen, in steps that compare.
ColourSpan blur_span(const MapThickness& a, const MapThickness& b);

/// Of edge points, plane points and others, when features colour the points.
Colour colour_of_feature(FeatureKind kind);

}  // namespace sweepscope::ui
