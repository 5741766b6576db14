#include "core/recording/csv/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sweepscope {
namespace {

constexpr std::size_t kBlock_bytes = std::size_t{1} << 18;
constexpr std::size_t kLongestLine_bytes = std::size_t{1} << 26;
constexpr std::size_t kMaxColumns = std::size_t{1} << 18;  // one for each beam and intensity of a scan
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

/// A line without its end; false at the end of the file.
Result<bool> CsvTable::read_line() {
  line_.clear();
  unended_ = true;
  while (true) {
    if (block_at_ == block_.size()) {
      block_.resize(kBlock_bytes);
      block_.resize(file_->read(std::as_writable_bytes(std::span(block_))));
      block_at_ = 0;
      if (block_.empty()) break;
    }
    const auto begin = block_.begin() + static_cast<std::ptrdiff_t>(block_at_);
    const auto end = std::find(begin, block_.end(), '\n');
    line_.append(begin, end);
    block_at_ = static_cast<std::size_t>(end - block_.begin());
    if (line_.size() > kLongestLine_bytes) {
      return unreadable(
          fmt::format("{}: line {} is longer than {} bytes", name_, line_number_ + 1, kLongestLine_bytes));
    }
    if (end == block_.end()) continue;
    ++block_at_;
    unended_ = false;
    break;
  }
  if (unended_ && line_.empty()) return false;
  ++line_number_;
  if (line_.ends_with('\r')) line_.pop_back();
  return true;
}

bool CsvTable::is_comment() const {
  // rostopic's columns begin with "%time".
  return line_.empty() || line_.front() == '#' || (line_.front() == '%' && !line_.starts_with("%time"));
}

/// Cells between separators, or between double quotes within which two stand for one. False where a quote has
/// no end.
bool CsvTable::split_line() {
  std::size_t count = 0;
  bool quoted = false;
  const auto next_cell = [&]() -> std::string& {
    if (count == cells_.size()) cells_.emplace_back();
    cells_[count].clear();
    return cells_[count++];
  };
  std::string* cell = &next_cell();
  for (std::size_t i = 0; i < line_.size(); ++i) {
    const char c = line_[i];
    if (c == '"' && quoted && i + 1 < line_.size() && line_[i + 1] == '"') {
      *cell += line_[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator_ && !quoted) {
      if (count > kMaxColumns) break;
      cell = &next_cell();
    } else {
      *cell += c;
    }
  }
  cells_.resize(count);
  for (std::string& text : cells_) {
    text.erase(0, std::min(text.find_first_not_of(" \t"), text.size()));
    text.erase(text.find_last_not_of(" \t") + 1);
  }
  return !quoted;
}

Result<CsvTable> CsvTable::open(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(std::move(file.error()));
  CsvTable table(std::move(*file), path.string());
  do {
    const auto read = table.read_line();
    if (!read) return tl::unexpected(read.error());
    if (!*read) break;
    if (table.line_.starts_with(kByteOrderMark)) table.line_.erase(0, kByteOrderMark.size());
  } while (table.is_comment());
  table.first_line_ = table.line_number_;
  if (auto named = table.name_columns(); !named) return tl::unexpected(named.error());
  return table;
}

Result<CsvTable> CsvTable::of_lines(std::string name, std::string_view first_line, std::size_t line_number) {
  CsvTable table(std::nullopt, std::move(name));
  table.line_ = first_line;
  table.line_number_ = table.first_line_ = line_number;
  if (auto named = table.name_columns(); !named) return tl::unexpected(named.error());
  return table;
}

/// Of the present line.
Result<void> CsvTable::name_columns() {
  for (const char separator : {';', '\t'})
    if (std::ranges::count(line_, separator) > std::ranges::count(line_, separator_)) separator_ = separator;
  if (!split_line() || cells_.size() > kMaxColumns)
    return unreadable(fmt::format("{} does not name columns", place()));
  columns_ = cells_;
  std::vector<std::string_view> names(columns_.begin(), columns_.end());
  std::erase(names, "");
  std::ranges::sort(names);
  if (const auto twice = std::ranges::adjacent_find(names); twice != names.end())
    return unreadable(fmt::format("{} names column {} twice", place(), *twice));
  return {};
}

std::size_t CsvTable::column(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::find(columns_, name) - columns_.begin());
}

Result<bool> CsvTable::next() {
  while (true) {
    const auto read = read_line();
    if (!read || !*read) return read;
    if (is_comment()) continue;
    if (split_line() && cells_.size() == columns_.size()) return true;
    if (unended_) {
      cut_short_ = true;
      return false;
    }
    return unreadable(wrong_count());
  }
}

Result<void> CsvTable::take(std::string_view line, std::size_t line_number) {
  line_ = line;
  line_number_ = line_number;
  if (split_line() && cells_.size() == columns_.size()) return {};
  return unreadable(wrong_count());
}

std::string CsvTable::wrong_count() const {
  return fmt::format("{} has {} cells, and line {} names {} columns", place(), cells_.size(), first_line_,
                     columns_.size());
}

std::string_view CsvTable::cell(std::size_t column) const {
  return column < cells_.size() ? std::string_view(cells_[column]) : std::string_view();
}

std::string CsvTable::place(std::size_t column) const {
  return fmt::format("{}, column {}", place(), column < columns_.size() ? columns_[column] : "?");
}

std::string CsvTable::place() const {
  return fmt::format("{}: line {}", name_, line_number_);
}

double CsvTable::fraction_read() const {
  return file_ ? static_cast<double>(file_->position()) / static_cast<double>(file_->size()) : 0;
}

}  // namespace sweepscope
