#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/recording/csv/csv_table.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// The lines of the two tables of csv_recording.hpp, from a file or a stream. Tables, rig and recording must
/// outlive what reads their lines.

/// Fail if a table has no stamps, or no column of a required group; warn of unknown columns, naming `file`.
Result<void> check_scan_columns(const CsvTable& table, const std::string& file, RawRecording& raw);
Result<void> check_motor_columns(const CsvTable& table, const std::string& file, RawRecording& raw);

class CsvCells;

/// A column of numbers and what they are multiplied by; beyond the last column if there is none.
struct Scaled {
  std::size_t at = 0;
  double factor = 1;
};

/// The first of these columns that a table has, with its factor.
Scaled first_of(const CsvTable& table, std::initializer_list<std::pair<std::string_view, double>> names);

/// The columns of a table's stamps, in s, ms, us or ns; beyond the last column if there are none. rostopic's
/// are field.header.stamp and %time.
struct StampColumns {
  struct Column {
    std::size_t at = 0;
    std::int64_t unit_ns = 0;
  };
  Column header, receive;

  explicit StampColumns(const CsvTable& table);

 private:
  static Column find(const CsvTable& table, bool receive);
};

/// The lasers of scans.csv.
class ScanLines {
 public:
  ScanLines(const CsvTable& table, const Rig& rig, RawRecording& raw);
  /// Reads the table's current line; returns its problem, or nothing.
  std::string take();
  /// What was read so far was taken away and counts no longer against the limit.
  void forget_lines() { beams_ = 0; }

 private:
  std::string take_beams(CsvCells& cells, RawScan& scan, RawLaser& laser);

  const CsvTable& table_;
  const Rig& rig_;
  RawRecording& raw_;
  StampColumns stamps_;
  std::array<Scaled, 6> numbers_;
  Scaled ranges_, intensities_;
  std::vector<std::size_t> range_columns_, intensity_columns_;  // a column for each beam
  std::size_t topic_ = 0;
  std::map<std::string, std::pair<std::size_t, std::size_t>> topics_;  // in topics and in lasers
  std::size_t beams_ = 0;
};

/// The joints of motor.csv.
class MotorLines {
 public:
  MotorLines(const CsvTable& table, const Rig& rig, RawRecording& raw);
  /// As of scans.
  std::string take();
  void forget_lines() { samples_ = 0; }

 private:
  void add(const std::string& topic, const std::string& name, const MessageStamps& stamps, double position);

  const CsvTable& table_;
  const Rig& rig_;
  RawRecording& raw_;
  StampColumns stamps_;
  std::size_t topic_, joint_;
  bool plain_;
  Scaled position_;
  std::vector<std::size_t> position_columns_, name_columns_;  // a column for each joint
  std::map<std::string, std::size_t> topics_;
  std::map<std::pair<std::string, std::string>, std::size_t> joints_;
  std::size_t samples_ = 0;
};

}  // namespace sweepscope
