#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

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

class Cells;

/// The columns of a table's stamps; beyond the last column if there are none.
struct StampColumns {
  std::size_t header, receive;

  explicit StampColumns(const CsvTable& table)
      : header(table.column("stamp_s")), receive(table.column("receive_s")) {}
};

/// The lasers of scans.csv.
class ScanLines {
 public:
  ScanLines(const CsvTable& table, const Rig& rig, RawRecording& raw);
  /// Reads the table's current line; returns its problem, or nothing.
  std::string take();

 private:
  std::string take_beams(Cells& cells, RawScan& scan, RawLaser& laser);

  const CsvTable& table_;
  const Rig& rig_;
  RawRecording& raw_;
  StampColumns stamps_;
  std::size_t numbers_[6], ranges_, intensities_, topic_;
  std::map<std::string, std::pair<std::size_t, std::size_t>> topics_;  // in topics and in lasers
  std::size_t beams_ = 0;
};

/// The joints of motor.csv.
class MotorLines {
 public:
  MotorLines(const CsvTable& table, const Rig& rig, RawRecording& raw);
  /// As of scans.
  std::string take();

 private:
  const CsvTable& table_;
  const Rig& rig_;
  RawRecording& raw_;
  StampColumns stamps_;
  std::size_t topic_, joint_, position_ = 0;
  bool degrees_ = false, plain_ = false;
  std::map<std::string, std::size_t> topics_;
  std::map<std::pair<std::string, std::string>, std::size_t> joints_;
  std::size_t samples_ = 0;
};

}  // namespace sweepscope
