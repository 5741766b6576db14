#pragma once

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimate_options.hpp"
#include "core/offset/kept_candidates.hpp"
#include "core/offset/prepared.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// Finds the offset between laser and motor, t_motor = t_laser + offset: directly, as an unknown of a least
/// squares (the default), or by the paper's criteria for a stationary rig (section 3.2) or a moving one
/// (section 3.3); see method_of. A recording that does not determine the offset gives an Estimate with
/// identifiable false and the reasons.
///
/// Errors: ExitCode::kWrongUsage for a range wider than the motor allows or without a candidate, for poses
/// with a stationary rig or with a method other than the direct one, for keeping candidates with the direct
/// method, which has none, and for a shard of the default search, which chooses its candidates as it goes;
/// ExitCode::kUnreadableInput for poses that do not overlap the recording.
///
/// The direct method uses the given poses, or the odometry or the IMU that the recording's rig names, in this
/// order: see MotionSource. The paper's methods take candidates from the store of `kept` if it has them, with
/// the same bytes; with a shard only its candidates are computed, without an answer.
///
/// On interruption the Estimate says so in `interrupted` and holds the candidates that were finished.
Result<Estimate> estimate(const PreparedRecording& prepared, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job);

/// The same for a recording that is not used for anything else.
Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options, const Job& job);
Result<Estimate> estimate(const Recording& recording, const EstimateOptions& options,
                          const KeptCandidates& kept, const Job& job);

/// The parts of a long recording that `estimate` uses if the rig was stationary, from an outline without
/// ranges; absent if it uses all of the recording.
std::optional<std::vector<RecordingPart>> parts_of_estimate(const Recording& outline,
                                                            const EstimateOptions& options);
/// `estimate` of a recording that holds these parts alone, with the same bytes; absent where the rig moved,
/// and all of the recording is needed.
Result<std::optional<Estimate>> estimate_by_parts(const Recording& parts, const EstimateOptions& options,
                                                  const Job& job);

}  // namespace sweepscope
