#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/io/input_file.hpp"

namespace sweepscope {

/// A table of values separated by commas, semicolons or tabs, read line by line: the first line that is
/// neither empty nor a comment (# or %) names the columns, and its most frequent separator is the table's.
/// Every error is one sentence that names the file, the line and the column.
class CsvTable {
 public:
  /// Opens the table and reads the columns' names.
  static Result<CsvTable> open(const std::filesystem::path& path);

  /// A table whose lines are passed one by one, the first of them here. `name` is its name in errors.
  static Result<CsvTable> of_lines(std::string name, std::string_view first_line, std::size_t line_number);

  const std::vector<std::string>& columns() const { return columns_; }
  /// The column of that name; columns().size() if there is none.
  std::size_t column(std::string_view name) const;
  bool has(std::string_view name) const { return column(name) < columns_.size(); }
  /// Whether a comma in a number is the decimal one, because others separate the cells.
  bool decimal_commas() const { return separator_ != ','; }

  /// Goes to the next line that is not empty; false at the end, or if the last line was cut short. Fails for
  /// a line with more or fewer cells than columns.
  Result<bool> next();
  /// Takes the next line of those passed one by one, like next().
  Result<void> take(std::string_view line, std::size_t line_number);
  /// A cell of this line; empty for a column that is not there.
  std::string_view cell(std::size_t column) const;
  /// "FILE: line 7, column ranges_m".
  std::string place(std::size_t column) const;
  /// "FILE: line 7".
  std::string place() const;
  /// The last line has no line end, so an error in it may mean that it was cut short.
  bool at_unended_line() const { return unended_; }
  bool cut_short() const { return cut_short_; }
  std::size_t line() const { return line_number_; }
  const std::string& name() const { return name_; }
  double fraction_read() const;

 private:
  CsvTable(std::optional<InputFile> file, std::string name)
      : file_(std::move(file)), name_(std::move(name)) {}
  Result<void> name_columns();
  std::string wrong_count() const;
  Result<bool> read_line();
  bool is_comment() const;
  bool split_line();

  std::optional<InputFile> file_;  // none: the lines are given
  std::string name_;
  std::vector<std::string> columns_;
  std::vector<char> block_;
  std::size_t block_at_ = 0;
  std::string line_;
  char separator_ = ',';
  std::size_t line_number_ = 0, first_line_ = 1;
  bool unended_ = false, cut_short_ = false;
  std::vector<std::string> cells_;
};

}  // namespace sweepscope
