#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace sweepscope {

/// A part of a recording and the offset that it has by itself. Times are seconds since the first scan.
struct OffsetWindow {
  double begin_s = 0, end_s = 0;
  double time_s = 0;                        // where the offset holds: the mean time of what it rests on
  std::optional<double> offset_s, sigma_s;  // both or none; none: the window tells no offset
  std::string reason;                       // then: why not, a sentence
  std::size_t scans = 0;                    // that the offset rests on
};

/// A sudden change of the offset, somewhere between the times of two windows.
struct OffsetJump {
  double begin_s = 0, end_s = 0;  // of the interval in which it lies
  double size_s = 0, sigma_s = 0;
};

/// How the offset runs over time: a line, constant or not, with jumps or none.
struct OffsetCourse {
  double middle_s = 0;               // where offset_s holds, seconds since the first scan
  double offset_s = 0, sigma_s = 0;  // what is common to all windows is not in the sigma
  double rate = 0, rate_sigma = 0;   // seconds per second; both 0 where the offset does not drift
  std::vector<OffsetJump> jumps;     // in the order of time
  double scatter = 1;                // by how much the windows scatter more than their sigmas say; >= 1
  std::size_t windows = 0;           // that have an offset

  bool constant() const { return rate_sigma == 0 && jumps.empty(); }
  /// The offset at a time since the first scan. A jump is taken to lie in the middle of its interval.
  double offset_at_s(double time_s) const;
};

/// The offsets of windows and the course through them; none where no window has an offset.
struct OffsetOverTime {
  std::vector<OffsetWindow> windows;  // in the order of time
  std::optional<OffsetCourse> course;
};

/// The course that the windows have evidence for. Constant, linear and with jumps are weighed against each
/// other by the residuals of a robust fit and the number of parameters (BIC; a rate and
/// a jump count as three each). A jump needs three windows on each side. Absent where no window has an
/// offset.
std::optional<OffsetCourse> course_of(const std::vector<OffsetWindow>& windows, double middle_s);

}  // namespace sweepscope
