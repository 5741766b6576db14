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
/// where the same names come again (a driver that was started anew) they are left aside. Empty lines, and
/// those that begin with #, are left aside as well.
class CsvStream {
 public:
  /// `name` is what failures and the recording are called. The rig must outlive the stream.
  CsvStream(std::string name, const Rig& rig);
  ~CsvStream();
  CsvStream(const CsvStream&) = delete;
  CsvStream& operator=(const CsvStream&) = delete;

  /// Takes a line without its end. Fails where columns are named that cannot be used. Any other line that is
  /// not as it should be is skipped and counted: a live stream may begin or break within one.
  Result<void> take(std::string_view line);
  /// All that was taken, as it is.
  const RawRecording& so_far() const;
  /// The same with a warning about the lines skipped.
  RawRecording heard() const;

 private:
  class Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace sweepscope
