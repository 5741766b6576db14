#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "render/comparison/compared_map.hpp"
#include "render/images/colour_table.hpp"

namespace sweepscope {

/// The value that colours the points: z in the map frame; the laser's intensity; the time; the direction in
/// which the motor turned; edge and plane points; the blur (thickness of the surface around a point);
/// the distance to the other map.
enum class ColourBy { kElevation, kIntensity, kTime, kDirection, kFeatures, kBlur, kDistance };

/// "elevation", "intensity", "time", "direction", "features", "blur", "distance", in the enumeration's order.
std::span<const std::string_view> colour_by_names();
/// An unknown name is ExitCode::kWrongUsage; the message lists the known names.
Result<ColourBy> colour_by(std::string_view name);

/// One of a few values, and its meaning.
struct ColourClass {
  std::string name;
  Colour colour;
};

/// The mapping from values to colours, and the legend.
struct Colouring {
  std::string title, unit;  // of the scalar bar; the unit may be empty
  ColourScale scale;
  std::vector<ColourClass> classes;  // if not empty, the legend lists them instead of a bar
};

struct ValueRange {
  double from = 0, to = 1;
};

/// The value of every point, in the colouring's unit; NaN if there is none. `other` is the map that
/// kDistance measures to. Failures are ExitCode::kWrongUsage: a map without feature kinds, or kDistance
/// without another map.
Result<std::vector<float>> colour_values(const ComparedMap& map, const ComparedMap* other, ColourBy by);

/// The colouring for values that are shown together: one range for all maps, the given one, or that of the
/// values without outliers.
Result<Colouring> make_colouring(ColourBy by, std::string_view table,
                                 std::span<const std::span<const float>> values,
                                 const std::optional<ValueRange>& range);

}  // namespace sweepscope
