#pragma once

// The mathematics: docs/algorithms.md, section 15.

#include <optional>
#include <string>
#include <vector>

#include "core/job.hpp"
#include "core/offset/judgement/evidence.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/over_time/offset_course.hpp"
#include "core/recording/recording.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// From the first scan to the last.
double recorded_s(const Recording& recording);

/// The default length of a window: 10 s, but at least 12 sweeps of the motor, and at most 360 windows.
double default_window_s(const MotorMotion& motor, double recorded_s);

/// Cuts a recording of this duration evenly into windows of at least `window_s`, in seconds since the first
/// scan.
std::vector<RecordingPart> windows_of(double recorded_s, double window_s);

/// Half as long windows of a recording as these, of at least kMinSweepsOfWindow sweeps each; empty where
/// these are as short already.
std::vector<RecordingPart> shorter_windows(const std::vector<RecordingPart>& windows,
                                           const MotorMotion& motor, double recorded_s);

/// The windows of a recording, of at least `asked_s`; absent or 0: default_window_s.
std::vector<RecordingPart> windows_over_time(const Recording& recording, const MotorMotion& motor,
                                             std::optional<double> asked_s);

/// Windows with fewer scans have no sweep.
inline constexpr std::size_t kMinScansOfWindow = 3;
inline constexpr const char* kNoScans = "There are no scans.";
inline constexpr const char* kInterruptedWindow = "Interrupted.";
/// A window that does not determine the offset.
OffsetWindow window_without(const RecordingPart& window, std::string reason);

/// The parts of these windows that follow_offset uses: at most 12 sweeps about the middle of each.
std::vector<RecordingPart> used_parts(const std::vector<RecordingPart>& windows, const MotorMotion& motor);

/// The offset of a stationary rig in each window, from at most 12 sweeps about its middle. The search begins
/// near `first_offset_s`, then near the offset of the window before, 10 ms (or ten units of a slow motor) to
/// either side; if there is no minimum there, it covers the default window. Sigmas contain the scatter of the
/// sweeps only. Incomplete if the job is cancelled; the same bytes for any number of threads.
std::vector<OffsetWindow> follow_offset(const Recording& recording, const std::vector<RecordingPart>& windows,
                                        double first_offset_s, const FeatureOptions& features,
                                        const Job& job);

/// The offset of each group of sweeps of a sample. The search for each begins where the line through the two
/// before it leads.
OffsetOverTime follow_groups(const Recording& sample, const std::vector<RecordingPart>& groups,
                             double first_offset_s, const FeatureOptions& features, const Job& job);

/// The motor's track moved onto the laser's clock by the course: its offset is 0 at all times.
MotorTrack without_course(const Recording& recording, const OffsetCourse& course);

/// The windows against their course. A window in which the offset jumps lies on neither side and is left out.
std::vector<PartOffset> parts_of_course(const OffsetOverTime& over_time);

/// The offset of the groups changes by more than 1 ms.
MaybeRefusal change_refusal(const OffsetOverTime& groups, double duration_s, double sweep_s);

}  // namespace sweepscope
