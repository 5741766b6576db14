#include "render/charts/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sweepscope {

Ticks round_ticks(double from, double to, int at_most) {
  Ticks ticks;
  if (!(to > from) || at_most < 1) return ticks;
  const double rough = (to - from) / at_most;
  double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    ticks.step = factor * power;
    if (ticks.step >= rough * (1 - 1e-9)) break;
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(ticks.step) + 1e-9)));
  const auto first = std::llround(std::ceil(from / ticks.step - 1e-9));
  const auto last = std::llround(std::floor(to / ticks.step + 1e-9));
  for (auto k = first; k <= last; ++k) {
    const double value = double(k) * ticks.step;
    ticks.values.push_back(value);
    std::string label = fmt::format("{:.{}f}", value, decimals);
    if (label.front() == '-') label.replace(0, 1, "−");
    ticks.labels.push_back(std::move(label));
  }
  return ticks;
}

double round_length(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length) + 1e-9));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= length * (1 + 1e-9)) return factor * power;
  }
  return power;
}

}  // namespace sweepscope
