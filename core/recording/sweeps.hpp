#pragma once

// The mathematics: docs/algorithms.md, section 1.

#include <cstddef>
#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// Duration of one half turn of the motor: from reversal to reversal, or of a motor that turns one way from
/// one multiple of 180 deg to the next; first and last, the part of one that was recorded. Times are on the
/// motor's clock, so sweeps do not depend on the offset.
struct Sweep {
  double begin_s = 0;         // of the half turn, at the reversal
  double end_s = 0;           // at the next reversal
  double steady_begin_s = 0;  // the part away from the reversals, where the motor's speed is steady
  double steady_end_s = 0;    // where it begins to slow down
  int direction = 0;          // +1 where the angle grows, -1 where it falls
  int side = 0;  // which sweeps it is compared with, those of the other: its direction, or of a motor that
                 // turns one way +1 for the faster ones and -1 for the slower
  double speed_rad_s = 0;  // mean over the steady part, > 0
};

/// The motion of the motor over the whole track.
struct MotorMotion {
  std::vector<Sweep> sweeps;      // in the order of time; neighbours turn in opposite directions, or one way
  double range_rad = 0;           // greatest minus least angle
  double median_speed_rad_s = 0;  // over the sweeps' steady parts
  double median_sweep_s = 0;      // over whole sweeps; over all where none is whole
  double mirror_shift_s = 0;      // see mirror_shift_s; of a motor that turns to and fro

  /// It turned by more than two turns and never back: all sweeps have one direction.
  bool one_way() const;
  /// One way: by how much the mean speeds of the two sides differ; 0 where there is one side only.
  double speeds_apart_rad_s() const;
  /// An offset turns the sides against each other by twice this times it: the speed itself where they turn in
  /// opposite directions, half the difference of their speeds where the motor turns one way.
  double lever_speed_rad_s() const;
};

/// Cuts a motor track at its reversals. A reversal is where the angle turns back by more than a twentieth of
/// its range and at least half a degree, so that encoder steps and jitter do not count. Pauses do not belong
/// to any sweep. A motor that turns one way is cut where its angle passes multiples of 180 deg, and its half
/// turns are divided into slower and faster ones so that the sides' mean speeds differ the most, by their
/// spread (Otsu's threshold).
MotorMotion find_sweeps(const MotorTrack& track);
/// Of a recording's motor: the profile of one in steps says whether it is its own mirror image.
MotorMotion find_sweeps(const Recording& recording);

/// The sweep of a scan that belongs to none.
inline constexpr std::size_t kNoSweep = static_cast<std::size_t>(-1);
/// Which sweep each scan belongs to at an offset, by the middle of its beams; kNoSweep where none.
std::vector<std::size_t> assign_sweeps(const std::vector<LaserScan>& scans, const std::vector<Sweep>& sweeps,
                                       double offset_s);

/// When the scans were taken: of a 3D scanner the first ring's.
std::vector<double> scan_stamps_s(const Recording& recording);

/// Whether the motor goes in steps and rests that last a scan and more.
bool goes_in_steps(const Recording& recording, const MotorMotion& motor);

/// By how much the motor turns from one scan line of a sweep to the next: from scan to scan, or where it goes
/// in steps and rests, all of whose scans fall on one line, about from rest to rest. 0 if there are fewer
/// than two scans.
double line_spacing_rad(const Recording& recording, const MotorMotion& motor);

/// The number of distinct positions in a sweep on which the scan lines of one direction fall: half of the
/// sweep lies in gaps between neighbours that are longer than the sweep divided by this number. For the
/// direction that has fewer; infinite for 3D scanners, whose lines cross. Of a motor in steps at most one for
/// each rest. Fewer than kMinDistinctLines do not determine an offset: neighbours do not lie on the same
/// surfaces.
double distinct_lines(const Recording& recording, const MotorMotion& motor, double offset_s);
/// See distinct_lines.
inline constexpr double kMinDistinctLines = 7.5;

}  // namespace sweepscope
