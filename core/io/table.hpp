#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"

namespace sweepscope {

enum class Alignment { kLeft, kCentre, kRight };

struct TableColumn {
  std::string title;
  std::string unit;  // empty: none
  Alignment alignment = Alignment::kRight;
  std::optional<int> decimals;  // of numbers in Markdown and LaTeX; none: as many as they have
};

/// A text, a number in the column's unit, or nothing.
using TableCell = std::variant<std::monostate, std::string, double>;

/// A table as data. Each row has a cell for each column.
struct Table {
  std::string title;
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;
};

/// As RFC 4180 but with "\n" as line end: a header line such as "offset_ms", then a line per row, numbers
/// with all their digits, absent cells empty. No title.
std::string to_csv(const Table& table);

/// A Markdown table whose columns are padded to equal widths, under its title in bold. Absent cells are "–".
std::string to_markdown(const Table& table);

/// A LaTeX tabular with booktabs' rules, its title as a comment. Everything that LaTeX reads as markup is
/// escaped; Greek letters and signs become mathematics, so that any engine can typeset them. Absent cells are
/// "--".
std::string to_latex(const Table& table);

/// As .csv, .md or .tex by the path's extension; another one is ExitCode::kWrongUsage.
Result<void> write_table(const std::filesystem::path& path, const Table& table);

}  // namespace sweepscope
