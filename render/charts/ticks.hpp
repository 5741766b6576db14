#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sweepscope {

/// Marks of an axis at round numbers.
struct Ticks {
  double step = 1;
  std::vector<double> values;       // within the axis's range, ascending
  std::vector<std::string> labels;  // with as many decimals as the step needs
};

/// Steps of 1, 2 or 5 times a power of ten, `at_most` of them over the range.
Ticks round_ticks(double from, double to, int at_most);

/// Ticks at dates (UTC), for values in seconds since `origin_s`, which is since 1970: at whole seconds,
/// minutes, hours, days, months or years, `at_most` of them over the range. `step` is the least distance
/// between two.
Ticks date_ticks(double from, double to, int at_most, std::int64_t origin_s);

/// The greatest of 1, 2 or 5 times a power of ten that is at most `length`.
double round_length(double length);

}  // namespace sweepscope
