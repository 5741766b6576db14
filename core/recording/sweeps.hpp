#pragma once

// The mathematics: docs/algorithms.md, section 1.

#include <cstddef>
#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// Duration of one half turn of the motor: from reversal to reversal, or, first and last, the part of one
/// that was recorded. Times are on the motor's clock, so sweeps do not depend on the offset.
struct Sweep {
  double begin_s = 0;  // of the half turn, at the reversal
  double end_s = 0;
  double steady_begin_s = 0;  // the part away from the reversals, where the motor's speed is steady
  double steady_end_s = 0;
  int direction = 0;       // +1 where the angle grows, -1 where it falls
  double speed_rad_s = 0;  // mean over the steady part, > 0
};

/// The motion of the motor over the whole track.
struct MotorMotion {
  std::vector<Sweep> sweeps;      // in the order of time; neighbours turn in opposite directions
  double range_rad = 0;           // greatest minus least angle
  double median_speed_rad_s = 0;  // over the sweeps' steady parts
  double median_sweep_s = 0;      // over whole sweeps; over all where none is whole
};

/// Cuts a motor track at its reversals. A reversal is where the angle turns back by more than a twentieth of
/// its range and at least half a degree, so that encoder steps and jitter do not count. Pauses do not belong
/// to any sweep.
MotorMotion find_sweeps(const MotorTrack& track);

/// Which sweep each scan belongs to at an offset, by the middle of its beams; kNoSweep where none.
inline constexpr std::size_t kNoSweep = static_cast<std::size_t>(-1);
std::vector<std::size_t> assign_sweeps(const std::vector<LaserScan>& scans, const std::vector<Sweep>& sweeps,
                                       double offset_s);

/// The number of distinct positions in a sweep on which the scan lines of one direction fall: half of the
/// sweep lies in gaps between neighbours that are longer than the sweep divided by this number. For the
/// direction that has fewer; infinite for 3D scanners, whose lines cross. Fewer than kMinDistinctLines do
/// not determine an offset: neighbours do not lie on the same surfaces.
double distinct_lines(const Recording& recording, const MotorMotion& motor, double offset_s);
inline constexpr double kMinDistinctLines = 7.5;

}  // namespace sweepscope
