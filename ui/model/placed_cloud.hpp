#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/colour_table.hpp"
#include "render/live_view.hpp"
#include "ui/model/solved_map.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// What of a map is shown and in which colours; follows from the settings.
struct CloudLook {
  Colouring colouring = Colouring::kElevation;
  std::string table = "viridis";
  double from = 0, to = 1;  // the values at the colour table's ends
  Heights heights = Heights::kSharp;
  double slab_from_m = 0, slab_to_m = 0;
  double time_from_s = 0, time_to_s = 0;

  bool operator==(const CloudLook&) const = default;
};

/// Points ready to be drawn, and the beam that each came from.
struct PlacedCloud {
  LivePointsPtr points = std::make_shared<LivePoints>();
  std::vector<std::uint32_t> beams;  // index into Beams
};
using PlacedCloudPtr = std::shared_ptr<const PlacedCloud>;

/// Where beams are placed: along a map's path, with the motor angle of an offset.
struct Placement {
  LoadedPtr loaded;
  SolvedMapPtr map;
  double offset_s = 0;

  bool operator==(const Placement&) const = default;
};

/// `coarse`: the chosen points alone. With `other`, points are coloured by their distance from where that
/// puts them, in millimetres, instead of the look's colouring.
PlacedCloud place_cloud(const Placement& placement, const CloudLook& look, bool coarse,
                        const Placement* other = nullptr);

/// The range that nearly all distances between two placements of the chosen points lie in, from 0, in
/// millimetres.
double difference_span_mm(const Placement& placement, const Placement& other);

/// The value that colours a beam placed at a point, in the unit of `colour_unit`.
double colour_value(const Placement& placement, Colouring colouring, std::uint32_t beam,
                    const std::array<float, 3>& place_m);
std::string colour_unit(Colouring colouring);

/// What the colour table's ends stand for: the range of values that a colouring has on both maps.
struct ColourSpan {
  double from = 0, to = 1;
};
ColourSpan colour_span(Colouring colouring, const Loaded& loaded, const SolvedMap* a, const SolvedMap* b);

}  // namespace sweepscope::ui
