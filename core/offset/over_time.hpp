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
#include "core/recording/recording_parts.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// How long a window is where nothing else is asked for: 10 s, at least 12 sweeps of the motor, and at most
/// 360 windows.
double default_window_s(const MotorMotion& motor, double recorded_s);

/// A recording of this duration cut evenly into windows of at least `window_s`: seconds since the first scan.
std::vector<RecordingPart> windows_of(double recorded_s, double window_s);

/// The windows that `options` ask for.
std::vector<RecordingPart> windows_over_time(const Recording& recording, const MotorMotion& motor,
                                             const EstimateOptions& options);

/// The parts of these windows that follow_offset goes by: at most 12 sweeps about each one's middle.
std::vector<RecordingPart> used_parts(const std::vector<RecordingPart>& windows, const MotorMotion& motor);

/// The offset of a stationary rig in each window by itself, from at most 12 sweeps about the window's middle.
/// The first one is sought near `first_offset_s` and each further one near those before it, 10 ms (or ten
/// units of a slow motor) to either side; where it is not there, over the default window of a search. Sigmas
/// are those of the sweeps' scatter alone. Unfinished where the job is cancelled; the same bytes for any
/// number of threads.
std::vector<OffsetWindow> follow_offset(const Recording& recording, const std::vector<RecordingPart>& windows,
                                        double first_offset_s, const FeatureOptions& features,
                                        const Job& job);

/// A recording's part and its estimate by the direct method.
using EstimatePart = std::function<Result<Estimate>(const Recording& part)>;

/// What the windows of a walk say, and the standard deviation of what may be wrong with all of them alike.
struct FollowedWalk {
  std::vector<OffsetWindow> windows;
  double common_sigma_s = 0;
};

/// The offset of a moving rig in windows: the recording is cut into stretches of half a minute and more, the
/// trajectory of each is solved by itself, and its parts are the windows. An offset that drifts is followed
/// from stretch to stretch. Errors are those of `estimate_part`.
Result<FollowedWalk> follow_walk(const Recording& recording, double window_s,
                                 const EstimatePart& estimate_part, const Job& job);

/// The offset over time of a recording that `search` was begun with, all of it or a sample of its sweeps: its
/// windows, their course, and as the answer the offset at the recording's middle. Unfinished where the job is
/// cancelled.
Result<Answer> answer_over_time(const OffsetSearch& search, const Recording& whole,
                                const EstimatePart& estimate_part, const Job& job);

/// The offset of the groups of sweeps of a sample, one after the other, each sought where those before it
/// lead.
OffsetOverTime follow_groups(const Recording& sample, const std::vector<RecordingPart>& groups,
                             double first_offset_s, const FeatureOptions& features, const Job& job);

/// The motor's track on the laser's clock, as the course says: whatever the offset did, it is 0 all along.
MotorTrack without_course(const Recording& recording, const OffsetCourse& course);

/// Why there is no one offset, where that of the groups changes by more than 1 ms.
Remark change_reason(const OffsetOverTime& groups, double duration_s);

}  // namespace sweepscope
