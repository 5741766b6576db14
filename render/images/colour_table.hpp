#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0, alpha = 255;
  bool operator==(const Colour&) const = default;
};

/// 256 colours from the smallest value to the largest.
using ColourTable = std::array<Colour, 256>;

/// viridis (the default), cividis, turbo, grey.
std::span<const std::string_view> colour_table_names();

/// An unknown name is ExitCode::kWrongUsage; the message lists the known names.
Result<ColourTable> colour_table(std::string_view name);

/// For values about 0, which is nearly white in the middle: violet below, orange above. Safe for colour-blind
/// eyes.
ColourTable diverging_table();

/// The mapping from values to colours: [from, to] is spread over the table; values beyond get the colours of
/// its ends, and NaN a separate one.
struct ColourScale {
  ColourTable table{};
  double from = 0, to = 1;
  Colour no_value{96, 100, 108};

  Colour at(double value) const;
};

}  // namespace sweepscope
