#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/apply/provenance.hpp"

namespace sweepscope {

/// A step of the offset at an instant of the laser's clock.
struct ShiftStep {
  std::int64_t laser_ns = 0;
  double size_s = 0;
};

/// t_motor = t_laser + offset, with an offset that may drift and step. In whole nanoseconds both ways.
class ClockShift {
 public:
  /// The same offset at all times.
  explicit ClockShift(double offset_s) : offset_s_(offset_s) {}
  /// The offset at an instant of the laser's clock, its rate (seconds per second) and its steps before and
  /// after that instant.
  ClockShift(double offset_s, std::int64_t at_laser_ns, double rate, std::vector<ShiftStep> steps)
      : offset_s_(offset_s), at_laser_ns_(at_laser_ns), rate_(rate), steps_(std::move(steps)) {}

  /// The offset at an instant of the laser's clock.
  double offset_s(std::int64_t laser_ns) const;
  /// A stamp of the laser on the motor's clock.
  std::int64_t motor_ns(std::int64_t laser_ns) const;
  /// A stamp of the motor on the laser's clock. At a step the motor's clock shows some times twice or never;
  /// these get the offset of one side of the step.
  std::int64_t laser_ns(std::int64_t motor_ns) const;

 private:
  double offset_s_;
  std::int64_t at_laser_ns_ = 0;
  double rate_ = 0;
  std::vector<ShiftStep> steps_;
};

/// The shift of an offset to apply, of a recording whose scans have stamps from `first_ns` to `last_ns`.
ClockShift clock_shift(const AppliedOffset& offset, std::int64_t first_ns, std::int64_t last_ns);

}  // namespace sweepscope
