#include "core/recording/csv/csv_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/recording/csv/csv_beams.hpp"
#include "core/recording/csv/csv_lines.hpp"
#include "core/recording/csv/csv_table.hpp"
#include "core/recording/take_messages.hpp"

namespace sweepscope {
namespace {

Result<void> check_live_columns(const CsvTable& table, const std::string& file, RawRecording& raw) {
  if (is_beam_table(table))
    return unreadable(fmt::format("{} names a beam per line, which only files may have; send a scan per line",
                                  table.place()));
  return check_scan_columns(table, file, raw);
}

/// One of the two tables, from when its columns are named.
template <typename Lines>
struct Table {
  std::string columns;  // the line that named them
  std::optional<CsvTable> table;
  std::optional<Lines> lines;
};

}  // namespace

class CsvStream::Tables {
 public:
  Tables(std::string name, const Rig& rig) : rig_(rig) { raw_.file = raw_.name = std::move(name); }

  Result<void> take(std::string_view line) {
    ++line_number_;
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') return {};
    const std::string_view word = line.substr(0, line.find(','));
    const std::string_view cells = line.substr(std::min(line.size(), word.size() + 1));
    if (word == "scan") return take(scans_, cells, check_live_columns);
    if (word == "motor") return take(motor_, cells, check_motor_columns);
    skip(fmt::format("{}: line {} begins with neither scan nor motor", raw_.file, line_number_));
    return {};
  }

  RawRecording heard() const {
    RawRecording raw = raw_;
    if (skipped_ > 0) raw.warnings.push_back(fmt::format("{} lines were skipped: {}", skipped_, problem_));
    return raw;
  }
  const RawRecording& so_far() const { return raw_; }
  RawRecording take_lines() {
    if (scans_.lines) scans_.lines->forget_lines();
    if (motor_.lines) motor_.lines->forget_lines();
    RawRecording taken = take_messages(raw_);
    if (skipped_ > 0 && !std::exchange(told_, true))
      taken.warnings.push_back(fmt::format("a line was skipped: {}", problem_));
    return taken;
  }

 private:
  template <typename Lines, typename Check>
  Result<void> take(Table<Lines>& of, std::string_view cells, const Check& check) {
    if (!of.table) {
      auto table = CsvTable::of_lines(raw_.file, cells, line_number_);
      if (!table) return tl::unexpected(table.error());
      if (auto checked = check(*table, raw_.file, raw_); !checked) return checked;
      of.columns = cells;
      of.table.emplace(std::move(*table));
      of.lines.emplace(*of.table, rig_, raw_);
      return {};
    }
    if (cells == of.columns) return {};
    if (auto taken = of.table->take(cells, line_number_); !taken) {
      skip(taken.error().message);
    } else if (const std::string problem = of.lines->take(); !problem.empty()) {
      skip(problem);
    }
    return {};
  }
  void skip(const std::string& problem) {
    if (skipped_++ == 0) problem_ = problem;
  }

  const Rig& rig_;
  RawRecording raw_;
  Table<ScanLines> scans_;
  Table<MotorLines> motor_;
  std::size_t line_number_ = 0, skipped_ = 0;
  std::string problem_;
  bool told_ = false;  // by take_lines
};

CsvStream::CsvStream(std::string name, const Rig& rig)
    : tables_(std::make_unique<Tables>(std::move(name), rig)) {}
CsvStream::~CsvStream() = default;

Result<void> CsvStream::take(std::string_view line) {
  return tables_->take(line);
}

const RawRecording& CsvStream::so_far() const {
  return tables_->so_far();
}

RawRecording CsvStream::heard() const {
  return tables_->heard();
}

RawRecording CsvStream::take_lines() {
  return tables_->take_lines();
}

}  // namespace sweepscope
