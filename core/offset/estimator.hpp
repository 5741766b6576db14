#pragma once

#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/loam/odometry.hpp"
#include "core/offset/candidates.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/given_poses.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

enum class Method { kStationary, kMoving, kDirect };
enum class Fit { kNone, kParabola };
enum class Scoring { kTwoStage, kLoam };

/// How an offset is looked for. What is left empty is decided from the recording.
struct EstimateOptions {
  std::optional<Method> method;     // none: what the motion test says
  std::optional<Method> assume;     // the kind of recording, instead of the motion test
  std::vector<OffsetRange> ranges;  // none, and no `around`: coarse to fine over the default window
  std::optional<OffsetsAround> around;
  std::optional<Fit> fit;  // none: a parabola for moving and for slow motors, else the least candidate
  Scoring scoring = Scoring::kTwoStage;
  double weight_c = 1.0;  // c of equation 3
  FeatureOptions features;
  OdometryOptions odometry;
  MappingOptions mapping;
  std::optional<GivenPoses> poses;  // of a moving rig, for the direct method
};

/// Finds the offset between laser and motor, t_motor = t_laser + offset, by the paper's methods, `stationary`
/// (section 3.2) or `moving` (section 3.3), or directly, as an unknown of the least squares itself (`direct`,
/// for rigs that stood still and for walks). A recording that cannot answer gives an Estimate with
/// identifiable false and the reasons. Errors: ExitCode::kWrongUsage for a range wider than the motor allows
/// or without a candidate, and for poses of a rig that stood still or for another method than the direct one;
/// ExitCode::kUnreadableInput for poses that do not overlap the recording.
///
/// The direct method goes by the poses given, or by the odometry or the IMU that the recording's rig names,
/// in this order: see MotionSource.
///
/// On interruption the Estimate says so in `interrupted` and holds the candidates that were finished.
Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, const Job& job);

}  // namespace sweepscope
