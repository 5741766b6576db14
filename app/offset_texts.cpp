#include "app/offset_texts.hpp"

#include <charconv>
#include <cmath>
#include <vector>

namespace sweepscope::app {
namespace {

// The three numbers of "a:b:c", with or without "ms" at the end.
std::optional<std::vector<double>> three_numbers(std::string text) {
  if (text.ends_with("ms")) text.resize(text.size() - 2);
  std::vector<double> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  for (int i = 0; i < 3; ++i) {
    double number = 0;
    if (at < end && *at == '+') ++at;
    const auto [after, error] = std::from_chars(at, end, number);
    const bool separated = i == 2 ? after == end : after != end && *after == ':';
    if (error != std::errc() || !separated || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    at = after + 1;
  }
  return numbers;
}

}  // namespace

std::optional<OffsetRange> parse_range_ms(const std::string& text) {
  const auto numbers = three_numbers(text);
  if (!numbers || !((*numbers)[0] <= (*numbers)[1]) || !((*numbers)[2] > 0)) return std::nullopt;
  return OffsetRange{(*numbers)[0] * 1e-3, (*numbers)[1] * 1e-3, (*numbers)[2] * 1e-3};
}

std::optional<OffsetsAround> parse_around_ms(const std::string& text) {
  const auto numbers = three_numbers(text);
  if (!numbers || !((*numbers)[1] > 0)) return std::nullopt;
  const double steps = (*numbers)[2];
  if (!(steps >= 0) || steps > 100000 || steps != std::floor(steps)) return std::nullopt;
  return OffsetsAround{(*numbers)[0] * 1e-3, (*numbers)[1] * 1e-3, static_cast<int>(steps)};
}

std::optional<Method> parse_method(const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  if (*text == "direct") return Method::kDirect;
  return *text == "moving" ? Method::kMoving : Method::kStationary;
}

}  // namespace sweepscope::app
