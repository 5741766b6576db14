#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// A recording as a growing stream of lines, for rigs without ROS: the lines of the two tables of
/// csv_recording.hpp, mixed as they come, each with the word `scan` or `motor` before it:
///
///     scan,stamp_s,angle_min_rad,angle_increment_rad,time_increment_s,ranges_m
///     motor,stamp_s,angle_rad
///     motor,1700000000.000,0.0131
///     scan,1700000000.004,-1.5708,0.004363,1.736e-5,3.21 3.20 nan 3.22
///
/// The first line of each word names its columns, with the tables' names and units, before any of its values;
/// if the same names come again (a driver that was restarted) they are ignored. Empty lines and lines that
/// begin with # are ignored too.
class CsvStream {
 public:
  /// `name` is the recording's name, also in errors. The rig must outlive the stream.
  CsvStream(std::string name, const Rig& rig);
  ~CsvStream();
  CsvStream(const CsvStream&) = delete;
  CsvStream& operator=(const CsvStream&) = delete;

  /// Takes a line without its end. Fails if the named columns cannot be used. Any other invalid line is
  /// skipped and counted: a live stream may begin or break within a line.
  Result<void> take(std::string_view line);
  /// Everything read so far, unmodified.
  const RawRecording& so_far() const;
  /// The same with a warning about the lines skipped.
  RawRecording heard() const;
  /// Takes it out, as take_messages() does, with a warning about the first line skipped.
  RawRecording take_lines();

 private:
  class Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace sweepscope
