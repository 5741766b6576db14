#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/loam/mapping.hpp"
#include "core/loam/odometry.hpp"
#include "core/offset/prepared/candidates.hpp"
#include "core/offset/prepared/given_poses.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

struct SolvedWalk;

/// What the rig did while it was recorded.
enum class RigKind { kStationary, kMoving };

/// What a rig is taken for before the motion test.
inline constexpr RigKind kUnknownKind = RigKind::kStationary;

/// How an offset is found: as an unknown of a least squares, or by the criteria of the paper's sections 3.2
/// and 3.3 at candidate offsets.
enum class Method { kDirect, kStationary, kMoving };

/// How an extremum is found among candidates: the best of them, or a parabola through those about it.
enum class Fit { kNone, kParabola };
/// How n and e are counted: along one solved trajectory, or at LOAM's own poses as the paper did.
enum class Scoring { kTwoStage, kLoam };

/// Where an offset is searched for, in seconds.
struct SearchRange {
  double from_s = 0, to_s = 0;  // from <= to
};

/// How an offset is searched for. Empty members are decided from the recording.
struct EstimateOptions {
  std::optional<Method> method;         // none: see method_of
  std::optional<RigKind> assume;        // instead of the motion test
  std::vector<OffsetRange> ranges;      // none, and no `around`: coarse to fine over the default window
  std::optional<OffsetsAround> around;  // candidates about an offset, besides `ranges`
  std::optional<SearchRange> search;    // none: all that can be distinguished, about 0 first
  std::optional<Fit> fit;  // none: a parabola for moving rigs and slow motors, else the best candidate
  std::optional<Scoring> scoring;      // none: two-stage
  std::optional<double> weight_c;      // c of equation 3; none: 1
  std::optional<double> edge_gate_m;   // delta_E of equation 4; none: that of `mapping`
  std::optional<double> plane_gate_m;  // delta_H of equation 5; none: that of `mapping`
  RigSolve solve;                      // of the rig, beside the offset
  FeatureOptions features;             // of scans
  OdometryOptions odometry;            // of sweeps, for the paper's criteria
  MappingOptions mapping;              // of a moving rig
  std::optional<double> over_time_s;   // the offset in windows of at least this length; 0: default_window_s
  std::optional<GivenPoses> poses;     // of a moving rig, for the direct method
  /// The trajectory that an estimate of the same recording was judged by: criteria along it cost no tracking.
  std::shared_ptr<const SolvedWalk> walk;
};

/// The method that an estimate uses, the same for every part of the program: the requested one; otherwise, if
/// an option of the paper's criteria is set or candidates are kept in a file, the paper's method for that
/// kind of rig; otherwise the direct method.
Method method_of(const EstimateOptions& options, RigKind kind, bool keeps_candidates = false);

/// How the map is searched, with the gates of the criteria.
MappingOptions mapping_of(const EstimateOptions& options);

}  // namespace sweepscope
