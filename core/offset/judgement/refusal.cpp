#include "core/offset/judgement/refusal.hpp"

#include <algorithm>
#include <array>

#include "core/offset/judgement/limits.hpp"

namespace sweepscope {
namespace {

using enum RefusalKind;

constexpr std::optional<double> kNoLimit;

// Ordered as the enumeration.
constexpr std::array kEntries{
    RefusalEntry{kFewMotorSamples, "few_motor_samples", double(kLimits.min_motor_samples), "samples",
                 "The motor has only {} samples."},
    RefusalEntry{kMotorDoesNotMove, "motor_does_not_move", kNoLimit, "deg",
                 "The motor does not move: its angle stays within {:.2f} deg."},
    RefusalEntry{
        kTwoMotorSources, "two_motor_sources", kNoLimit, "",
        "The motor's samples come from two sources whose motions differ: {}. Record the joint with one "
        "publisher, or name another topic (motor: {{topic: ...}} in a rig file)."},
    RefusalEntry{
        kHardlyRadians, "hardly_radians", kLimits.max_swing_deg, "deg",
        "The motor's angles are hardly radians: as such they span {:.0f} deg, at {:.0f} deg/s{}. If they "
        "are degrees, write `motor: {{unit: deg}}` into a rig file (--rig)."},
    RefusalEntry{
        kOneWayAtOneSpeed, "one_way_at_one_speed", kLimits.min_speed_change, "of its speed",
        "The motor turns one way only, at one speed ({:.1f} turns in {:.1f} s): an offset cannot be "
        "distinguished from the encoder's zero, and does not blur the map. What blurs it is the mount, "
        "which can be solved for (estimate --solve mount). For the offset record 5 s at one speed and 5 s at half of it."},
    RefusalEntry{kOneWayMotorAndCriteria, "one_way_motor_and_criteria", kNoLimit, "",
                 "The paper's criteria compare sweeps of opposite directions, and this motor turns one "
                 "way. Use the direct method (--method direct)."},
    RefusalEntry{kOneWayMotorAndMovingRig, "one_way_motor_and_moving_rig", kNoLimit, "",
                 "The rig moved, and its motor turns one way: an offset then looks like a rotation of "
                 "the rig about the motor's axis. Record 5 s at one speed and 5 s at half of it while "
                 "the rig is stationary."},
    RefusalEntry{kUnevenScanTimes, "uneven_scan_times", kLimits.max_scan_time_spread, "of a period",
                 "The scans' receive times are uneven (90 % within {:.0f} ms), and a scan takes {:.0f} "
                 "ms: when each scan was taken is not known, and no constant offset can correct that."},
    RefusalEntry{kSparseMotorSamples, "sparse_motor_samples", kLimits.min_samples_per_sweep, "per sweep",
                 "The motor is sampled only {:.1f} times per sweep: its motion in between is not known."},
    RefusalEntry{kMotorGaps, "motor_gaps", kLimits.max_scans_in_gaps, "of the scans",
                 "Most scans lie in gaps of the motor's samples: only {} of {} have samples around them."},
    RefusalEntry{kFewSweeps, "few_sweeps", double(kLimits.min_sweeps), "sweeps",
                 "Fewer than two sweeps have both scans and motor samples at every offset searched."},
    RefusalEntry{kFewScanLines, "few_scan_lines", kLimits.min_scan_lines, "per sweep",
                 "All sweeps of a direction have the same {:.2g} scan lines, too few to match the "
                 "surfaces of both directions. Turn the motor more slowly, or make the sweeps a little "
                 "longer or shorter."},
    RefusalEntry{kBeamTimesUnknown, "beam_times_unknown", kLimits.max_beam_time_sigma_units, "units",
                 "When the beams were fired is not known: the time of the last beam of a scan may be "
                 "off by {:.1f} ms. Set laser.time_increment_s in a rig file{}."},
    RefusalEntry{kFewSharedSurfaces, "few_shared_surfaces", kNoLimit, "",
                 "Too few surfaces were measured in both directions{}."},
    RefusalEntry{kScanLinesDoNotRepeat, "scan_lines_do_not_repeat", kLimits.max_line_spread_deg, "deg",
                 "The scanner's lines do not repeat, and the direct method compares equal beams of a "
                 "stationary rig. Use the stationary method (--method stationary)."},
    RefusalEntry{kEdgeOfSearch, "edge_of_search", kNoLimit, "ms",
                 "The minimum {} lies on the edge of the searched range, at {:.1f} ms: the offset is outside "
                 "the range or cannot be determined."},
    RefusalEntry{
        kFlatCost, "flat_cost", kLimits.min_cost_depth, "of the median",
        "The scene does not constrain the offset: sweeps of opposite directions fit each other about "
        "equally well at every offset ({:.1f} mm apart at best, {:.1f} mm at the median)."},
    RefusalEntry{
        kLinesTooFarApart, "lines_too_far_apart", kLimits.min_lines_a_sweep, "scan lines per sweep",
        "The scan lines of a sweep are too far apart, {:.0f} deg of the motor's angle, to compare what sweeps of "
        "opposite directions measured: they fit each other about equally well at every offset. Turn the motor more "
        "slowly or less far, or use a scanner that makes more scans a second."},
    RefusalEntry{kSweepsFitNowhere, "sweeps_fit_nowhere", kLimits.max_distance_m, "m",
                 "Sweeps of opposite directions do not fit each other at any offset ({:.0f} mm apart "
                 "at best): the rig or the scene moved, or its surfaces are too rough."},
    RefusalEntry{kTwoOffsetsFit, "two_offsets_fit", kLimits.max_rival_depth, "of the depth",
                 "Two offsets fit about equally well: {:.0f} ms and {:.0f} ms."},
    RefusalEntry{kRigMoved, "rig_moved", kNoLimit, "",
                 "{} Use the method for moving rigs (--method moving), or, if the rig was stationary, "
                 "say so (--assume stationary)."},
    RefusalEntry{kShortWalk, "short_walk", double(kLimits.min_walk_sweeps),
                 "sweeps besides those that settle",
                 "{}The recording is too short for a moving rig: {} sweeps, at least {} are needed, and 40 s "
                 "of walking for a good result."},
    RefusalEntry{kMovedTooFar, "moved_too_far", kLimits.max_motion_sigma_units, "units",
                 "The rig moved too far from sweep to sweep to be treated as stationary: the offset is "
                 "uncertain by +- {:.1f} ms."},
    RefusalEntry{kCalibrationMoved, "calibration_moved", kNoLimit, "",
                 "The rig moved: a calibration requires a stationary rig."},
    RefusalEntry{kFewMatches, "few_matches", double(kLimits.min_matches), "matches",
                 "Only {} of {} points lie on surfaces that were measured in the other direction."},
    RefusalEntry{kNotConverged, "not_converged", kNoLimit, "ms", "The least squares did not converge."},
    RefusalEntry{
        kLargeResiduals, "large_residuals", kLimits.max_residual_noises, "of the range noise",
        "Even at the best offset the points lie {:.0f} mm from the surfaces that the other direction "
        "measured, and the ranges scatter by only {:.0f} mm: the beams are not where or when the "
        "recording says, or the scene moved."},
    RefusalEntry{kSmallLever, "small_lever", kLimits.min_lever, "of the reach",
                 "The scene does not constrain the offset: turning the motor by 1 deg moves the points only "
                 "{:.1f} mm away from their surfaces."},
    RefusalEntry{kLongSweeps, "long_sweeps", kLimits.max_hopeless_units, "units",
                 "A sweep takes {:.2f} s, long enough for the rig to sway within it: this alone makes "
                 "the offset uncertain by +- {:.2f} ms. With sweeps of {:.1f} s it would be +- {:.2f} "
                 "ms."},
    RefusalEntry{kSmoothMotor, "smooth_motor", kNoLimit, "ms",
                 "The motor slows down before it turns back, so a sway of the rig in step with it "
                 "looks like an offset: this alone makes the offset uncertain by +- {:.2f} ms. A motor "
                 "that turns at constant speed and reverses at once does not have this limit."},
    RefusalEntry{kTrackLost, "track_lost", double(kLimits.min_tracked_sweeps), "sweeps", "{}"},
    RefusalEntry{kPosesCoverFewSweeps, "poses_cover_few_sweeps", double(kLimits.min_tracked_sweeps), "sweeps",
                 "{} covers too few sweeps of the recording."},
    RefusalEntry{kNoMatchesAtOffset, "no_matches_at_offset", kNoLimit, "",
                 "The map has no matches at the best offset of the walk."},
    RefusalEntry{kMapNotSharpest, "map_not_sharpest", kLimits.sharpest_side_units, "units",
                 "The map is not sharpest at the best offset of the walk: e is {:.1f} mm there, and "
                 "{:.1f} and {:.1f} mm to either side."},
    RefusalEntry{kSweepsNotRegistered, "sweeps_not_registered", kNoLimit, "",
                 "The sweeps could not be registered to each other at any candidate offset."},
    RefusalEntry{
        kCriteriaDisagree, "criteria_disagree", kLimits.max_criteria_apart_units, "units",
        "The two criteria disagree: the maximum of n is at {:.2f} ms, the minimum of e at {:.2f} ms."},
    RefusalEntry{kRollDoesNotFollow, "roll_does_not_follow", kLimits.min_roll_slope, "of 2 omega",
                 "The scene does not constrain the offset: turning the motor by 1 deg turns the registered "
                 "sweeps by only {:.2f} deg."},
    RefusalEntry{kSweepsApart, "sweeps_apart", kLimits.max_sweeps_apart_m, "m",
                 "The rig moved: even at the best offset the sweeps are {:.2f} m apart."},
    RefusalEntry{kBeyondSearch, "beyond_search", kNoLimit, "ms",
                 "The best offset lies beyond the edge of the searched range, at {:.1f} ms."},
    RefusalEntry{kSigmaUnknown, "sigma_unknown", kNoLimit, "",
                 "There is too little information to estimate an uncertainty."},
    RefusalEntry{kSigmaTooLarge, "sigma_too_large", kLimits.max_sigma_units, "units",
                 "There is too little information: the offset would be uncertain by +- {:.1f} ms."},
    RefusalEntry{kClocksDrift, "clocks_drift", kLimits.max_change_s * 1e3, "ms",
                 "The clocks drift apart by {:.0f} ppm: by {:.1f} ms over these {:.1f} s. {}"},
    RefusalEntry{kOffsetJumps, "offset_jumps", kLimits.max_change_s * 1e3, "ms",
                 "The offset jumps by {:.1f} ms between {:.1f} and {:.1f} s. {}"},
    RefusalEntry{kOffsetChanges, "offset_changes", kLimits.max_change_s * 1e3, "ms",
                 "The offset changes: it is {:.1f} ms near {:.1f} s and {:.1f} ms elsewhere. {}"},
    RefusalEntry{
        kNoCourse, "no_course", kLimits.max_change_s * 1e3, "ms",
        "The offset follows neither a constant, a rate nor jumps: at {:.1f} s it is {:.1f} ms, and {:.1f} "
        "ms by the best course through all windows."},
    RefusalEntry{kNoWindow, "no_window", kNoLimit, "", "No window determines the offset. The first: {}"},
    RefusalEntry{
        kRecordingsDiffer, "recordings_differ", kLimits.max_chi_square_sigmas, "sigma above its mean",
        "The recordings do not agree on one rig (chi-square {:.0f} for {} degrees of freedom): {}{}."},
    RefusalEntry{kListeningEnded, "listening_ended", kNoLimit, "", "{}"},
    RefusalEntry{kInterrupted, "interrupted", kNoLimit, "",
                 "Interrupted; the curve holds the candidates that were finished."},
    RefusalEntry{kUnknown, "unknown", kNoLimit, "", "{}"},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < kEntries.size(); ++i)
    if (kEntries[i].kind != static_cast<RefusalKind>(i)) return false;
  return kEntries.back().kind == kUnknown;
}
static_assert(in_order());

}  // namespace

std::span<const RefusalEntry> refusal_entries() {
  return kEntries;
}

const RefusalEntry& entry_of(RefusalKind kind) {
  return kEntries[static_cast<std::size_t>(kind)];
}

RefusalKind refusal_kind_of(std::string_view code) {
  const auto found = std::ranges::find(
      kEntries, code, [](const RefusalEntry& entry) { return std::string_view(entry.code); });
  return found == kEntries.end() ? kUnknown : found->kind;
}

std::vector<std::string> texts_of(const Refusals& refusals) {
  std::vector<std::string> texts;
  texts.reserve(refusals.size());
  for (const Refusal& refusal : refusals) texts.push_back(refusal.text);
  return texts;
}

}  // namespace sweepscope
