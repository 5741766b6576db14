#include "core/recording/csv/csv_cells.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

constexpr std::int64_t kLastSecond = 9'000'000'000;  // what fits into 63 bits of nanoseconds

/// "12.5" of a unit of a second as 12'500'000'000, digit by digit: a double holds no nanoseconds since 1970.
std::optional<std::int64_t> parse_stamp_ns(std::string_view text, std::int64_t unit_ns) {
  std::int64_t whole = 0;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, whole);
  if (error != std::errc() || whole < 0 || whole > kLastSecond * (kSecond_ns / unit_ns) ||
      text.front() == '-')
    return std::nullopt;
  std::int64_t ns = whole * unit_ns;
  if (after == end) return ns;
  if (*after != '.' && *after != ',') return std::nullopt;
  std::int64_t digit_ns = unit_ns / 10;
  for (const char* digit = after + 1; digit < end; ++digit, digit_ns /= 10) {
    if (*digit < '0' || *digit > '9') return std::nullopt;
    ns += digit_ns * (*digit - '0');
  }
  return ns;
}

/// What a stamp beyond all seconds counts; empty where it is none.
std::string_view unit_by_size(std::string_view text) {
  double value = 0;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || after != text.data() + text.size() || value < 1e11) return "";
  return value < 1e14 ? "ms" : value < 1e17 ? "us" : "ns";
}

}  // namespace

std::int64_t CsvCells::stamp_ns(const StampColumns::Column& column) {
  const std::string_view text = table_.cell(column.at);
  if (text.empty()) return 0;
  const auto ns = parse_stamp_ns(text, column.unit_ns);
  if (ns) return *ns;
  const std::string_view unit = unit_by_size(text);
  if (column.unit_ns != kSecond_ns || unit.empty())
    refuse(column.at, text, "is not a time in decimal seconds (0 or more)");
  else
    refuse(
        column.at, text,
        fmt::format("is no time in seconds: by its size it counts {}; name the column stamp_{}", unit, unit));
  return 0;
}

std::size_t CsvCells::list(const Scaled& column, const std::vector<std::size_t>& columns,
                           std::vector<float>& numbers) {
  const std::size_t before = numbers.size();
  // An array that is shorter than the first one leaves its last cells empty.
  for (const std::size_t at : columns)
    if (!table_.cell(at).empty()) numbers.push_back(number<float>(at));
  std::string_view rest = table_.cell(column.at);
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    if (word.empty()) continue;
    if (!parse(word, numbers.emplace_back())) {
      refuse(column.at, word, "is not a number");
      break;
    }
    if (column.factor != 1) numbers.back() = static_cast<float>(numbers.back() * column.factor);
  }
  return numbers.size() - before;
}

void CsvCells::refuse(std::size_t column, std::string_view text, std::string_view why) {
  constexpr std::size_t kMaxQuoted = 40;
  if (problem_.empty())
    problem_ = fmt::format("{}: \"{}\" {}", table_.place(column), text.substr(0, kMaxQuoted), why);
}

}  // namespace sweepscope
