#include "core/campaign/expected_offset.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace sweepscope {
namespace {

void skip_spaces(std::string_view& text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
}

bool skip(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

/// A number in milliseconds with the spaces and the unit after it.
std::optional<double> take_ms(std::string_view& text) {
  skip_spaces(text);
  double number = 0;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(after - text.data()));
  skip_spaces(text);
  skip(text, "ms");
  skip_spaces(text);
  return number;
}

bool take_plus_minus(std::string_view& text) {
  constexpr std::array<std::string_view, 3> kSigns{"+-", "+/-", "±"};
  for (const std::string_view sign : kSigns)
    if (skip(text, sign)) return true;
  return false;
}

}  // namespace

bool ExpectedOffset::holds(double found_ms) const {
  constexpr double kLastDigit_ms = 1e-9;
  return std::abs(found_ms - offset_ms) <= tolerance_ms + kLastDigit_ms;
}

std::string ExpectedOffset::words() const {
  return fmt::format("{} +- {} ms", offset_ms, tolerance_ms);
}

Result<ExpectedOffset> parse_expected_offset(std::string_view text) {
  std::string_view left = text;
  const auto offset_ms = take_ms(left);
  const bool plus_minus = offset_ms && take_plus_minus(left);
  const auto tolerance_ms = plus_minus ? take_ms(left) : std::nullopt;
  if (tolerance_ms && *tolerance_ms > 0 && left.empty()) return ExpectedOffset{*offset_ms, *tolerance_ms};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("needs an offset and a tolerance above 0 in milliseconds, with decimal points, "
                             "such as 24+-0.5 or \"24 ± 0.5\", and got {}",
                             text));
}

}  // namespace sweepscope
