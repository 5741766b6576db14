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

/// 256 colours from the least value to the greatest.
using ColourTable = std::array<Colour, 256>;

/// viridis (the default), cividis, turbo, grey.
std::span<const std::string_view> colour_table_names();

/// An unknown name is ExitCode::kWrongUsage, with the names that there are.
Result<ColourTable> colour_table(std::string_view name);

/// What value has which colour: [from, to] is spread over the table; values beyond have its ends' colours,
/// and NaN has one of its own.
struct ColourScale {
  ColourTable table{};
  double from = 0, to = 1;
  Colour no_value{96, 100, 108};

  Colour at(double value) const;
};

}  // namespace sweepscope
