#pragma once

#include <span>
#include <vector>

#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// The sweeps of a motor that is still turning. The last one is under way unless it has ended.
struct MotorSoFar {
  MotorMotion motion;
  double begin_s = 0, end_s = 0;  // of the samples
  bool last_ended = false;        // the motor has rested since for longer than the sweep took

  /// The sweeps that ended; `all`: nothing follows.
  std::span<const Sweep> ended(bool all) const;
  /// How long it has not turned before `now_s`.
  double rested_s(double now_s) const;
  /// When the first sweep begins that ends after `time_s`; `otherwise_s` if there is none.
  double begin_s_after(double time_s, double otherwise_s) const;
  /// The samples that tell later sweeps, if those before `placed_s` are done.
  double needed_from_s(double placed_s, double now_s) const;
};

/// A reversal lies where it does in the whole track: where a sweep begins depends on how far it goes, so that
/// the one under way is continued to the end of the motor's range.
MotorSoFar motor_so_far(const MotorTrack& track);

}  // namespace sweepscope
