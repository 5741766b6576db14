#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/offset/over_time/offset_course.hpp"
#include "core/offset/prepared/options.hpp"
#include "core/offset/search/answer.hpp"

namespace sweepscope {

struct SolvedRig;

/// Of a long recording of a stationary rig groups of sweeps, spread evenly, are used.
struct SweepSample {
  std::size_t groups = 0, sweeps = 0, of_sweeps = 0;  // `of_sweeps`: that the recording has
};

/// One of several recordings of one rig, in the estimate of all.
struct RecordingOfRig {
  std::string recording;                    // its name
  std::optional<double> offset_s, sigma_s;  // with the rig of all; absent if it does not determine the offset
  double share = 0;                         // of the weight of the common offset
  // What it says of the rig by itself, one standard deviation in the worst direction; absent if nothing.
  std::optional<double> turn_sigma_rad, shift_sigma_m;
  std::optional<double> residual_before_m, residual_after_m;  // of its flat surfaces
  std::vector<std::string> reasons;  // why it does not determine the offset, or the rig
};

/// How several recordings of one rig agree, see estimate_together.
struct Together {
  std::vector<RecordingOfRig> recordings;  // in the order given
  bool own_offsets = false;                // each has an offset of its own; only the rig is common
  double chi_square = 0;                   // of their differences from the common answer
  int degrees_of_freedom = 0;              // 0: not compared
};

/// The answer to "what is the offset?", with its evidence and how it was found.
struct Estimate : Answer {
  std::string recording;                    // Recording::name
  Method method = Method::kDirect;          // that gave the answer
  std::optional<RigKind> kind;              // absent if the motion test was not run
  std::string kind_reason;                  // why: a sentence
  bool identifiable = false;                // the recording determines the offset; else see refusals
  std::optional<OffsetOverTime> over_time;  // where it was asked for; offset_s then holds at the middle
  std::optional<SweepSample> sample;        // none: all sweeps are used
  /// The part of a recording that moved in which the rig was stationary, if the answer is of it alone. In
  /// seconds since the first scan of the whole recording, as --window takes them.
  std::optional<RecordingPart> stationary_part;
  std::vector<BeamReading> readings;  // see ReadReport
  std::size_t sweeps = 0;             // used
  std::size_t scans = 0;              // used
  double cpu_s = 0;                   // computing time, of all threads
  double wall_s = 0;                  // time that passed
  /// What of the rig was solved for beside the offset; null where nothing was.
  std::shared_ptr<const SolvedRig> rig;
  std::optional<Together> together;  // of several recordings

  /// The motor turns one way at one speed: any offset gives the same map but for a turn about the motor's
  /// axis, so that none is found, and none is needed for a map or for the rig.
  bool offset_is_gauge() const {
    return std::ranges::any_of(
        refusals, [](const Refusal& refusal) { return refusal.kind == RefusalKind::kOneWayAtOneSpeed; });
  }
  bool interrupted = false;  // the curve holds the candidates finished until then

  /// Why it is not identifiable, whole sentences.
  std::vector<std::string> reasons() const { return texts_of(refusals); }
};

}  // namespace sweepscope
