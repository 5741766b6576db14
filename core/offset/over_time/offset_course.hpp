#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace sweepscope {

/// A part of a recording and its offset. Times are seconds since the first scan.
struct OffsetWindow {
  double begin_s = 0, end_s = 0;            // begin <= end
  double time_s = 0;                        // the mean time of the scans used
  std::optional<double> offset_s, sigma_s;  // both or none; none: not determined
  std::string reason;                       // if not determined: why, a sentence
  std::size_t scans = 0;                    // used
};

/// A sudden change of the offset, somewhere between the times of two windows.
struct OffsetJump {
  double begin_s = 0, end_s = 0;   // of the interval in which it lies
  double size_s = 0, sigma_s = 0;  // added to the offset; one standard deviation
};

/// The offset as a function of time: a line, constant or not, with or without jumps.
struct OffsetCourse {
  double middle_s = 0;               // where offset_s holds, seconds since the first scan
  double offset_s = 0, sigma_s = 0;  // without the error common to all windows
  double rate = 0, rate_sigma = 0;   // seconds per second; both 0 where the offset does not drift
  std::vector<OffsetJump> jumps;     // in the order of time
  double scatter = 1;                // of the windows, in their sigmas; >= 1
  std::size_t windows = 0;           // that have an offset

  /// Neither drift nor jumps.
  bool constant() const { return rate_sigma == 0 && jumps.empty(); }
  /// The offset at a time since the first scan. A jump counts at the middle of its interval.
  double offset_at_s(double time_s) const;
};

/// The offsets of windows and the course through them; none where no window has an offset.
struct OffsetOverTime {
  std::vector<OffsetWindow> windows;   // in the order of time
  std::optional<OffsetCourse> course;  // through those that have an offset
};

/// The course with the lowest BIC among constant, linear, and either with jumps, from the residuals of a
/// robust fit; a rate and a jump count as three parameters each. A jump requires two windows on each side.
/// Absent if no window has an offset.
std::optional<OffsetCourse> course_of(const std::vector<OffsetWindow>& windows, double middle_s);

}  // namespace sweepscope
