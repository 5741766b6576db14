#pragma once

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimate_options.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/offset/prepared/recording_source.hpp"

namespace sweepscope {

/// Finds the offset between laser and motor, t_motor = t_laser + offset: directly, as an unknown of a least
/// squares (the default), or by the paper's criteria for a stationary rig (section 3.2) or a moving one
/// (section 3.3); see method_of. A recording that does not determine the offset gives an Estimate with
/// identifiable false and the refusals. Of a moving rig that is refused, the part in which it was stationary
/// is estimated alone if there is one (motion_course), by the same judgement, and is the answer if it has one
/// (Estimate::stationary_part); not with EstimateOptions::assume, poses, an offset over time, a rig to solve
/// for, the moving method or kept candidates. The recording may be in memory, prepared already, or in a file,
/// of which only those parts are read that EstimatePlan names.
///
/// Errors: those of reading; ExitCode::kWrongUsage for a range wider than the motor allows or without a
/// candidate, for poses with a stationary rig or with a method other than the direct one, for keeping
/// candidates with the direct method, which has none, and for a shard of the default search, which chooses
/// its candidates as it goes; ExitCode::kUnreadableInput for poses that do not overlap the recording.
///
/// The direct method uses the given poses, or the odometry or the IMU that the recording's rig names, in this
/// order: see MotionSource. The paper's methods take candidates from the store of `kept` if it has them, with
/// the same bytes; with a shard only its candidates are computed, without an answer.
///
/// On interruption the Estimate says so in `interrupted` and holds the candidates that were finished.
Result<Estimate> estimate(const RecordingSource& source, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job);
/// The same without kept candidates.
Result<Estimate> estimate(const RecordingSource& source, const EstimateOptions& options, const Job& job);

}  // namespace sweepscope
