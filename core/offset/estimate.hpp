#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/loam/mapping.hpp"
#include "core/offset/offset_course.hpp"

namespace sweepscope {

struct SolvedWalk;
struct SolvedRig;

/// What the rig did while it was recorded.
enum class RigKind { kStationary, kMoving };

/// How an offset is found: as an unknown of a least squares, or by the criteria of the paper's sections 3.2
/// and 3.3 at candidate offsets.
enum class Method { kDirect, kStationary, kMoving };

/// What was computed at one candidate offset. A value is absent if the method has no such criterion or the
/// registration failed; a failed candidate never wins.
struct CurvePoint {
  double offset_s = 0;
  std::optional<double> d;                    // equation 3, mean over the pairs of sweeps
  std::optional<double> translation_m;        // equation 1, mean over the pairs of sweeps
  std::optional<double> rotation_rad;         // equation 2, mean over the pairs of sweeps
  std::optional<double> signed_rotation_rad;  // about the motor's axis, alternating in sign; 0 at the offset
  std::optional<double> n;                    // equation 6, matches
  std::optional<double> e_m;                  // equation 7, mean distance per match
  std::optional<double> capped_cost_m;  // mean distance over a fixed set of features, in which a miss pays
                                        // the cap
};

/// Where one criterion has its extremum, and its value there.
struct CriterionOptimum {
  std::string name;  // "d", "n", "e", "capped_cost" or "direct"
  double offset_s = 0;
  double value = 0;
};

/// A motion from another source that an estimate used.
struct UsedMotion {
  enum class Kind { kPoses, kOdometry, kImu };
  Kind kind = Kind::kPoses;
  std::string name;      // the file, or the topic
  bool trusted = false;  // used as the truth; otherwise as a prior
  /// Adding it to the motion's stamps gives the laser's clock. Absent if it could not be determined.
  std::optional<double> time_shift_s, time_shift_sigma_s;
};

/// The evidence of the direct method's least squares.
struct FitEvidence {
  bool converged = false;
  int iterations = 0;  // 0: of a walk, where each part has its own
  std::size_t features = 0, matches = 0;
  double residual_m = 0;  // robust deviation of the distances; of a walk, their mean (e)
  double lever_m = 0,
         reach_m = 0;  // rms of n . (a x p) and of |a x p|: how far a turn of 1 rad moves the points
};

/// A part of an offset's standard deviation.
struct SigmaPart {
  std::string name;  // "statistical", "stamps", "encoder", "motion", "path", "sway", "halves" or "rig"
  double sigma_s = 0;
};

/// What a rig that is not as its rig file says would add to an offset's error: not part of sigma.
struct RigEffects {
  double play_s_rad = 0;                   // per angle of gear play
  std::optional<double> mount_tilt_s_rad;  // per angle, in the worst direction; of stationary rigs
};

/// Of a long recording of a stationary rig groups of sweeps, spread evenly, are used.
struct SweepSample {
  std::size_t groups = 0, sweeps = 0, of_sweeps = 0;  // `of_sweeps`: that the recording has
};

/// The answer to "what is the offset?", with its evidence. t_motor = t_laser + offset.
struct Estimate {
  std::string recording;
  Method method = Method::kDirect;
  std::optional<RigKind> kind;  // absent if the motion test was not run
  std::string kind_reason;      // why: a sentence
  bool identifiable = false;
  std::optional<double> offset_s;
  std::optional<double> sigma_s;
  std::vector<SigmaPart> sigma_parts;     // what it is made of, see docs/algorithms.md, section 13
  std::optional<RigEffects> rig_effects;  // of the direct method
  std::optional<double> drift_ppm;  // by how much the motor's clock runs faster than the laser's, as measured
  std::optional<OffsetOverTime> over_time;  // where it was asked for; offset_s then holds at the middle
  std::optional<SweepSample> sample;        // none: all sweeps are used
  std::vector<Interval> lost;  // when a moving rig's trajectory is not known: left out; since the first scan
  std::vector<std::string> warnings;
  std::vector<std::string> reasons;  // why it is not identifiable, whole sentences
  std::vector<CriterionOptimum> criteria;
  std::vector<CurvePoint> curve;  // offsets ascend
  std::size_t sweeps = 0;
  std::size_t scans = 0;
  double cpu_s = 0;
  double wall_s = 0;
  std::optional<UsedMotion> motion;  // what a moving rig's trajectory went by, besides the scans
  std::optional<FitEvidence> fit;    // of the direct method
  /// A moving rig's trajectory, on which all of this is based; null in an estimate that was read from a file.
  std::shared_ptr<const SolvedWalk> walk;
  /// What of the rig was solved for beside the offset; null where nothing was, and in an estimate that was
  /// read from a file.
  std::shared_ptr<const SolvedRig> rig;
  bool interrupted = false;  // the curve holds the candidates finished until then
};

}  // namespace sweepscope
