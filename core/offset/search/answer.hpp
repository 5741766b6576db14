#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/loam/mapping.hpp"
#include "core/offset/judgement/refusal.hpp"
#include "core/offset/prepared/curve_point.hpp"

namespace sweepscope {

struct SolvedWalk;

/// A motion from another source that an estimate used.
struct UsedMotion {
  /// A file of poses, or a topic of the recording.
  enum class Kind { kPoses, kOdometry, kImu };
  Kind kind = Kind::kPoses;  // where it is from
  std::string name;          // the file, or the topic
  bool trusted = false;      // used as the truth; otherwise as a prior
  /// Adding it to the motion's stamps gives the laser's clock. Absent if it could not be determined.
  std::optional<double> time_shift_s, time_shift_sigma_s;
};

/// The evidence of the direct method's least squares.
struct FitEvidence {
  bool converged = false;                 // of a walk: successive solutions agreed
  int iterations = 0;                     // 0: of a walk, where each part has its own
  std::size_t features = 0, matches = 0;  // used, and of these matched to surfaces
  double residual_m = 0;                  // robust deviation of the distances; of a walk, their mean (e)
  // Rms of n . (a x p) and of |a x p|: how far a turn of 1 rad moves the points.
  double lever_m = 0, reach_m = 0;
};

/// A part of an offset's standard deviation.
struct SigmaPart {
  std::string name;    // "statistical", "stamps", "encoder", "motion", "path", "sway", "halves" or "rig"
  double sigma_s = 0;  // parts add up as squares
};

/// What a rig that is not as its rig file says would add to an offset's error: not part of sigma.
struct RigEffects {
  double play_s_rad = 0;                   // per angle of gear play
  std::optional<double> mount_tilt_s_rad;  // per angle, in the worst direction; of stationary rigs
};

/// The result of one method, with its evidence. t_motor = t_laser + offset. There is no offset where there
/// are refusals.
struct Answer {
  std::optional<double> offset_s, sigma_s;  // in seconds; one standard deviation
  std::vector<SigmaPart> sigma_parts;       // what it is made of, see docs/algorithms.md, section 13
  std::optional<RigEffects> rig_effects;    // of the direct method
  std::optional<double> drift_ppm;  // by how much the motor's clock runs faster than the laser's, as measured
  std::vector<CriterionOptimum> criteria;  // where each criterion by itself is best
  std::vector<CurvePoint> curve;           // offsets ascend
  std::vector<Interval> lost;  // when a moving rig's trajectory is not known: left out; since the first scan
  std::optional<UsedMotion> motion;  // what a moving rig's trajectory went by, besides the scans
  std::optional<FitEvidence> fit;    // of the direct method
  /// A moving rig's trajectory, on which all of this is based; null in an estimate that was read from a file.
  std::shared_ptr<const SolvedWalk> walk;
  std::vector<std::string> warnings;  // whole sentences for a person
  Refusals refusals;                  // why there is no offset; empty: there is one

  /// What limits an answer: a refusal where there can be none, a warning otherwise.
  void limit_by(const std::optional<Refusal>& limit, bool refuses) {
    if (refuses)
      add(refusals, limit);
    else if (limit)
      warnings.push_back(limit->text);
  }
};

}  // namespace sweepscope
