#include "render/images/colour_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pcl/common/colors.h>

#include <algorithm>
#include <cmath>
#include <ranges>

namespace sweepscope {
namespace {

constexpr std::array<std::string_view, 4> kNames{"viridis", "cividis", "turbo", "grey"};

/// Coefficients of a polynomial per channel, the constant first; channels from 0 to 1.
using Polynomial = std::array<double, 6>;

double evaluate(const Polynomial& polynomial, double t) {
  double value = 0;
  for (const double coefficient : polynomial | std::views::reverse) value = value * t + coefficient;
  return value;
}

std::uint8_t to_byte(double channel) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0, 1.0)));
}

ColourTable from_polynomials(const Polynomial& red, const Polynomial& green, const Polynomial& blue) {
  ColourTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double t = static_cast<double>(i) / 255;
    table[i] = {to_byte(evaluate(red, t)), to_byte(evaluate(green, t)), to_byte(evaluate(blue, t))};
  }
  return table;
}

/// Van der Walt and Smith, 2015 (CC0).
ColourTable viridis() {
  ColourTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const pcl::RGB colour = pcl::ViridisLUT::at(i);
    table[i] = {colour.r, colour.g, colour.b};
  }
  return table;
}

/// Nunez, Anderton and Renslow, 2018; polynomials fitted by Jamie Perkins, published with d3-scale-chromatic.
ColourTable cividis() {
  return from_polynomials(
      {-4.54 / 255, -35.34 / 255, 2381.73 / 255, -6402.7 / 255, 7024.72 / 255, -2710.57 / 255},
      {32.49 / 255, 170.73 / 255, 52.82 / 255, -131.46 / 255, 176.58 / 255, -67.37 / 255},
      {81.24 / 255, 442.36 / 255, -2482.43 / 255, 6167.24 / 255, -6614.94 / 255, 2475.67 / 255});
}

/// Mikhailov, 2019; polynomials fitted by Ruofei Du.
ColourTable turbo() {
  return from_polynomials({0.13572138, 4.61539260, -42.66032258, 132.13108234, -152.94239396, 59.28637943},
                          {0.09140261, 2.19418839, 4.84296658, -14.18503333, 4.27729857, 2.82956604},
                          {0.10667330, 12.64194608, -60.58204836, 110.36276771, -89.90310912, 27.34824973});
}

/// Not from black, which would vanish on the dark background.
ColourTable grey() {
  return from_polynomials({0.25, 0.75}, {0.25, 0.75}, {0.25, 0.75});
}

}  // namespace

std::span<const std::string_view> colour_table_names() {
  return kNames;
}

Result<ColourTable> colour_table(std::string_view name) {
  if (name == "viridis") return viridis();
  if (name == "cividis") return cividis();
  if (name == "turbo") return turbo();
  if (name == "grey") return grey();
  return failure(ExitCode::kWrongUsage,
                 fmt::format("There is no colour table \"{}\"; there are {}", name, fmt::join(kNames, ", ")));
}

/// PuOr of eleven classes (Brewer, ColorBrewer 2.0), reversed, with straight lines between.
ColourTable diverging_table() {
  constexpr std::array<Colour, 11> kClasses{{{45, 0, 75},
                                             {84, 39, 136},
                                             {128, 115, 172},
                                             {178, 171, 210},
                                             {216, 218, 235},
                                             {247, 247, 247},
                                             {254, 224, 182},
                                             {253, 184, 99},
                                             {224, 130, 20},
                                             {179, 88, 6},
                                             {127, 59, 8}}};
  ColourTable table;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double at = static_cast<double>(i) / 255 * (kClasses.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(at), kClasses.size() - 2);
    const auto between = [&](std::uint8_t from, std::uint8_t to) {
      return to_byte(std::lerp(from / 255.0, to / 255.0, at - static_cast<double>(below)));
    };
    const Colour &from = kClasses[below], &to = kClasses[below + 1];
    table[i] = {between(from.red, to.red), between(from.green, to.green), between(from.blue, to.blue)};
  }
  return table;
}

Colour ColourScale::at(double value) const {
  if (std::isnan(value)) return no_value;
  const double t = to > from ? (value - from) / (to - from) : 0.5;
  return table[static_cast<std::size_t>(std::lround(255 * std::clamp(t, 0.0, 1.0)))];
}

}  // namespace sweepscope
