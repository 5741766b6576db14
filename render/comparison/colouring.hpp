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

/// What the points' colours say: z in the map frame; the laser's intensity; the instant; which way the motor
/// turned; edge and plane points; the local blur (how thick the surface around a point is); how far the other
/// map is.
enum class ColourBy { kElevation, kIntensity, kTime, kDirection, kFeatures, kBlur, kDistance };

/// "elevation", "intensity", "time", "direction", "features", "blur", "distance", in the enumeration's order.
std::span<const std::string_view> colour_by_names();
/// An unknown name is ExitCode::kWrongUsage, with the names that there are.
Result<ColourBy> colour_by(std::string_view name);

/// One of few values, and what it stands for.
struct ColourClass {
  std::string name;
  Colour colour;
};

/// How values become colours, and what the legend says.
struct Colouring {
  std::string title, unit;  // of the scalar bar; the unit may be empty
  ColourScale scale;
  std::vector<ColourClass> classes;  // where there are some, the legend lists them and there is no bar
};

struct ValueRange {
  double from = 0, to = 1;
};

/// The value of every point, in the colouring's unit; NaN where there is none. `other` is the map that
/// kDistance measures to. Failures are ExitCode::kWrongUsage: a map without feature kinds, or alone.
Result<std::vector<float>> colour_values(const ComparedMap& map, const ComparedMap* other, ColourBy by);

/// The colouring for values that are shown together: one range for all maps, the given one or that of the
/// values without their outermost part.
Result<Colouring> make_colouring(ColourBy by, std::string_view table,
                                 std::span<const std::span<const float>> values,
                                 const std::optional<ValueRange>& range);

}  // namespace sweepscope
