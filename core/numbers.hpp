#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numbers>
#include <vector>

namespace sweepscope {

/// Degrees times this are radians.
inline constexpr double kRadPerDeg = std::numbers::pi / 180;
/// Radians times this are degrees.
inline constexpr double kDegPerRad = 180 / std::numbers::pi;
/// A whole turn.
inline constexpr double kFullCircle_rad = 2 * std::numbers::pi;
/// Nanoseconds in a second.
inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// The normal distribution's standard deviation as a multiple of its median absolute deviation.
inline constexpr double kSigmaPerMedianDeviation = 1.4826;

/// The median; the upper one of two middle values. 0 without values.
template <typename Number>
Number median(std::vector<Number> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// From each value to the next.
template <typename Values, typename Projection = std::identity>
std::vector<double> spacings(const Values& values, Projection projection = {}) {
  std::vector<double> all;
  for (std::size_t i = 1; i < values.size(); ++i)
    all.push_back(std::invoke(projection, values[i]) - std::invoke(projection, values[i - 1]));
  return all;
}

/// The quantile of `fraction`, in [0, 1]. Reorders `values`, which must not be empty.
template <typename Number>
Number quantile(std::vector<Number>& values, double fraction) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace sweepscope
