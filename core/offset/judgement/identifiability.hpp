#pragma once

// The mathematics: docs/algorithms.md, sections 13.3 and 14. The limits: limits.hpp; the sentences:
// refusal.cpp.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/offset/judgement/refusal.hpp"
#include "core/offset/prepared/options.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {

/// Whether a recording is refused, and why; absent if there is nothing against it.
using MaybeRefusal = std::optional<Refusal>;

/// The motor has too few samples, does not move, or turns one way at one speed.
MaybeRefusal motor_refusal(const MotorTrack& track, const MotorMotion& motor);
/// The motor's samples are of two sources, or in another unit than radians.
MaybeRefusal motor_faults_refusal(const ReadReport& report);
/// A motor that turns one way does not determine the offset of a moving rig, or by the paper's criteria.
MaybeRefusal one_way_refusal(const MotorMotion& motor, RigKind kind, Method method);

/// The scans' receive times are so uneven that when each scan was taken is not known: their deviation from
/// whole periods, nine times in ten, is as much as +- a quarter of a period and more than the motor's speed
/// allows.
MaybeRefusal scan_times_refusal(const Recording& recording, const SearchScale& scale);
/// A sweep has so few samples of the motor that its motion between them decides the answer.
MaybeRefusal samples_refusal(const MotorTrack& track, const MotorMotion& motor, const SearchScale& scale);
/// Doubt about the beams' times is larger than what the motor's speed should allow.
MaybeRefusal beam_times_refusal(const Recording& recording, const SearchScale& scale);
/// Of the scans made while the motor was recorded, most lie in gaps of its samples.
MaybeRefusal gaps_refusal(const Recording& recording, const std::vector<char>& covered, double min_s,
                          double max_s);
/// The scan lines fall on so few places of a sweep, again and again, that too few surfaces are seen by both
/// directions.
MaybeRefusal lines_refusal(double distinct_lines);

/// The minimum of a coarse curve lies at its end, a second minimum is nearly as deep, or there is none: of a
/// 2D scanner with few scans a sweep because of what lies between its scan lines.
MaybeRefusal edge_refusal(const std::vector<CurvePoint>& coarse, std::size_t best);
MaybeRefusal rival_refusal(const std::vector<CurvePoint>& coarse, std::size_t best, const SearchScale& scale);
MaybeRefusal flat_refusal(const std::vector<CurvePoint>& coarse, std::size_t best,
                          const OffsetProblem& problem);
/// The lines of a 3D scanner do not repeat, as with Livox's patterns: beams of one number point elsewhere in
/// each. For a stationary rig the direct method compares them.
MaybeRefusal unrepeated_lines_refusal(const Recording& recording);

/// The scene's surfaces hardly move when the motor's angle is turned: n . (a x p) is small against |a x p|.
MaybeRefusal lever_refusal(double lever_m, double reach_m);
/// The sweeps of a moving rig are so long that they dominate the uncertainty; with the uncertainty for
/// shorter ones. `unseen_s`: what bends of the path within the sweeps leave uncertain, of `sigma_s`.
MaybeRefusal long_sweeps_refusal(const Recording& recording, const MotorMotion& motor, double unseen_s,
                                 double sigma_s);
/// With a motor that slows down before it turns back, a sway in step with it cannot be excluded.
MaybeRefusal smooth_motor_refusal(double sway_s, double sigma_s);

/// What to do where the offset changes, in a recording that is long enough for it.
inline constexpr std::string_view kSearchOverTime =
    "Search over time for the offset and its course (estimate --over-time).";
/// The clocks drift apart by more than max(1 ms, 3 sigma) over the recording, and by more than chance.
MaybeRefusal drift_refusal(const Trend& trend, double duration_s, double sigma_s,
                           std::string_view advice = kSearchOverTime);
/// Sigma is larger than the motor's speed should allow, or not known.
MaybeRefusal sigma_refusal(std::optional<double> sigma_s, const SearchScale& scale);

}  // namespace sweepscope
