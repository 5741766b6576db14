#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/recording/csv/csv_lines.hpp"

namespace sweepscope {

/// Whether a table of scans has a beam per line: a time, an angle and a range.
bool is_beam_table(const CsvTable& table);

/// The scans of such a table. A scan ends where the angle turns back. A column `angle` or `distance` without
/// a unit is judged by its values: angles beyond a turn are degrees, ranges beyond 200 m millimetres.
class BeamLines {
 public:
  /// All must outlive it.
  BeamLines(const CsvTable& table, RawRecording& raw);
  /// Reads the table's current line; returns its problem, or nothing.
  std::string take();
  /// Adds the laser; call it once, last. Fails where angles are not evenly spaced.
  Result<void> finish(const std::string& file);

 private:
  struct Beam {
    MessageStamps stamps;
    double angle = 0, range = 0;
    std::size_t line = 0;
  };
  std::string units_by_size(const std::string& file);
  bool add_scan(std::size_t begin, std::size_t end, RawLaser& laser);

  const CsvTable& table_;
  RawRecording& raw_;
  StampColumns stamps_;
  Scaled angle_, range_;
  bool angle_unit_, range_unit_;  // stated
  std::vector<Beam> beams_;
};

}  // namespace sweepscope
