#pragma once

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "core/recording/csv/csv_lines.hpp"

namespace sweepscope {

/// Reads the cells of a line; the first that is wrong is kept as the problem.
class CsvCells {
 public:
  explicit CsvCells(const CsvTable& table) : table_(table) {}

  /// 0 where the cell is empty.
  std::int64_t stamp_ns(const StampColumns::Column& column);
  template <typename T>
  T number(std::size_t column) {
    const std::string_view text = table_.cell(column);
    T value = 0;
    if (!text.empty() && !parse(text, value)) refuse(column, text, "is not a number");
    return value;
  }
  template <typename T>
  T number(const Scaled& column) {
    if (column.factor == 1) return number<T>(column.at);
    return static_cast<T>(number<double>(column.at) * column.factor);
  }
  /// Appends the numbers of a cell with spaces between them, or of a cell each, and gives how many.
  std::size_t list(const Scaled& column, const std::vector<std::size_t>& columns,
                   std::vector<float>& numbers);
  std::string text(std::size_t column, const char* otherwise) const {
    const std::string_view text = table_.cell(column);
    return text.empty() ? otherwise : std::string(text);
  }
  void refuse(std::size_t column, std::string_view text, std::string_view why);
  const std::string& problem() const { return problem_; }

 private:
  template <typename T>
  bool parse(std::string_view text, T& value) const {
    std::string with_point;
    if (table_.decimal_commas() && text.find('.') == std::string_view::npos) {
      with_point = text;
      std::ranges::replace(with_point, ',', '.');
      text = with_point;
    }
    const char* const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && after == end;
  }

  const CsvTable& table_;
  std::string problem_;
};

}  // namespace sweepscope
