#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <functional>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/identifiability.hpp"
#include "core/offset/offset_course.hpp"
#include "core/offset/offset_search.hpp"
#include "core/recording/recording.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// The default length of a window: 10 s, but at least 12 sweeps of the motor, and at most 360 windows.
double default_window_s(const MotorMotion& motor, double recorded_s);

/// Cuts a recording of this duration evenly into windows of at least `window_s`, in seconds since the first
/// scan.
std::vector<RecordingPart> windows_of(double recorded_s, double window_s);

/// The windows for these options.
std::vector<RecordingPart> windows_over_time(const Recording& recording, const MotorMotion& motor,
                                             const EstimateOptions& options);

/// The parts of these windows that follow_offset uses: at most 12 sweeps about the middle of each.
std::vector<RecordingPart> used_parts(const std::vector<RecordingPart>& windows, const MotorMotion& motor);

/// The offset of a stationary rig in each window, from at most 12 sweeps about its middle. The search begins
/// near `first_offset_s`, then near the offset of the window before, 10 ms (or ten units of a slow motor) to
/// either side; if there is no minimum there, it covers the default window. Sigmas contain the scatter of the
/// sweeps only. Incomplete if the job is cancelled; the same bytes for any number of threads.
std::vector<OffsetWindow> follow_offset(const Recording& recording, const std::vector<RecordingPart>& windows,
                                        double first_offset_s, const FeatureOptions& features,
                                        const Job& job);

/// A recording's part and its estimate by the direct method.
using EstimatePart = std::function<Result<Estimate>(const Recording& part)>;

/// The windows of a walk, and the standard deviation of the error that they have in common.
struct FollowedWalk {
  std::vector<OffsetWindow> windows;
  double common_sigma_s = 0;
};

/// The offset of a moving rig in windows. The recording is cut into stretches of at least half a minute, the
/// trajectory of each is solved separately, and its parts are the windows. A drifting offset is followed from
/// stretch to stretch. Errors are those of `estimate_part`.
Result<FollowedWalk> follow_walk(const Recording& recording, double window_s,
                                 const EstimatePart& estimate_part, const Job& job);

/// The offset over time: windows, their course, and as the answer the offset at the middle of the recording.
/// `search` holds all of the recording or a sample of its sweeps. Incomplete if the job is cancelled.
Result<Answer> answer_over_time(const OffsetSearch& search, const Recording& whole,
                                const EstimatePart& estimate_part, const Job& job);

/// The offset of each group of sweeps of a sample. The search for each begins where the line through the two
/// before it leads.
OffsetOverTime follow_groups(const Recording& sample, const std::vector<RecordingPart>& groups,
                             double first_offset_s, const FeatureOptions& features, const Job& job);

/// The motor's track moved onto the laser's clock by the course: its offset is 0 at all times.
MotorTrack without_course(const Recording& recording, const OffsetCourse& course);

/// The reason for a refusal if the offset of the groups changes by more than 1 ms.
Remark change_reason(const OffsetOverTime& groups, double duration_s);

}  // namespace sweepscope
