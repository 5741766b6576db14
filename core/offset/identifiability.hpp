#pragma once

// The mathematics: docs/algorithms.md, sections 13.3 and 14.

#include <optional>
#include <string>
#include <vector>

#include "core/offset/estimate.hpp"
#include "core/offset/search_window.hpp"
#include "core/offset/uncertainty.hpp"

namespace sweepscope {

/// Reasons why a recording cannot tell its offset and warnings where it tells little, each a whole sentence
/// for a person; empty where there is nothing to say.
using Remark = std::optional<std::string>;

/// The least cost of a coarse curve lies at its end, or a second minimum is nearly as deep, or it has none.
Remark edge_reason(const std::vector<CurvePoint>& coarse, std::size_t best);
Remark rival_reason(const std::vector<CurvePoint>& coarse, std::size_t best, const SearchScale& scale);
Remark flat_reason(const std::vector<CurvePoint>& coarse, std::size_t best);

/// The lines of a 3D scanner do not come back to where they were, as those of Livox's patterns do not: beams
/// of one number point elsewhere in each. The direct method compares them where a rig stood still.
Remark unrepeated_lines_reason(const Recording& recording);

/// Scans that go by receive times come so unevenly that it is not known which was made when: what their
/// spacings leave beside whole periods is, nine times in ten, as much as +- a quarter of a period, and more
/// than the motor's speed allows.
Remark stamps_reason(const Recording& recording, const SearchScale& scale);
/// Of the scans made while the motor was recorded, most lie in gaps of its samples.
Remark gaps_reason(const Recording& recording, const std::vector<char>& covered, double min_s, double max_s);

/// A sweep has so few samples of the motor that what it did between them decides the answer.
Remark sampling_reason(const MotorTrack& track, const MotorMotion& motor, const SearchScale& scale);

/// The scan lines fall on so few places of a sweep, again and again, that too few surfaces are seen by both
/// directions.
Remark lines_reason(double distinct_lines);

/// The clocks drift apart by more than max(1 ms, 3 sigma) over the recording, and by more than chance.
Remark drift_reason(const Trend& trend, double duration_s, double sigma_s);
/// The scene's surfaces hardly move when the motor's angle is turned: n . (a x p) is small against |a x p|.
Remark lever_reason(double lever_m, double reach_m);
/// How often the encoder samples a sweep; 0 of fewer than two samples.
double samples_per_sweep(const MotorTrack& track, const MotorMotion& motor);
/// What the encoder leaves uncertain, whatever the scatter of the sweeps says, since each repeats it: the
/// steps of its angle, and the straight lines between its samples, which cut the reversals' corners.
double encoder_step_sigma_s(const MotorTrack& track, const MotorMotion& motor);
double encoder_sampling_sigma_s(const MotorTrack& track, const MotorMotion& motor);
/// What surfaces seen by few lines leave uncertain: sweeps that see the same lines err alike.
double lines_sigma_s(const MotorMotion& motor, double distinct_lines);
/// What scans whose stamps scatter leave uncertain at least, however few sweeps there are to tell it by:
/// their spacings tell how much each errs.
double stamps_sigma_s(const Recording& recording);
/// What doubt about the beams' times leaves (ReadReport::beam_time_doubt_s): the answer rests on beams from
/// the first to the last of a scan, so it may err by what the last one does.
double beam_times_sigma_s(const Recording& recording);
/// That doubt is larger than what the motor's speed should allow.
Remark beam_times_reason(const Recording& recording, const SearchScale& scale);
/// What encoder, lines and doubt about the beams' times leave: what the scatter of the sweeps does not tell
/// at an offset.
double unseen_sigma_s(const Recording& recording, const MotorMotion& motor, double offset_s);
/// Sigma is larger than what the motor's speed should allow.
Remark sigma_reason(std::optional<double> sigma_s, const SearchScale& scale);

/// What a part of a walk errs by beside its own sigma, as the parts of the walks of tuning/ in
/// tests/benchmark/walks scatter. Where all its sweeps see the same few angles, a path that is bent alike in
/// each of them fits nearly as well as the true one. The longer a sweep, the more a path may bend within it:
/// the first 55 walks of tests/benchmark/random_walks err like the square of a sweep's duration beyond 0.5 s.
double unseen_of_part_s(const Recording& recording, const MotorMotion& motor, std::size_t sweeps);
/// The sweeps of a moving rig are long enough to decide how sure the answer is; with how sure shorter ones
/// would make it. `unseen_s`: what bends of the path within the sweeps leave uncertain, of `sigma_s`.
Remark long_sweeps_warning(const Recording& recording, const MotorMotion& motor, double unseen_s,
                           double sigma_s);
/// A motor that slows down before it turns back leaves a sway in step with it in doubt.
Remark smooth_motor_warning(double sway_s, double sigma_s);
/// Whether the scanner has several rings, as 3D scanners do: each of their turns sees surfaces again,
/// whatever the motor does.
bool has_rings(const Recording& recording);
/// Whether a sweep takes so nearly a whole number of scans that so many sweeps all see the same angles.
bool sees_same_angles(const Recording& recording, const MotorMotion& motor, std::size_t sweeps);
/// All sweeps do: few surfaces are seen twice.
Remark aliased_warning(const Recording& recording, const MotorMotion& motor);
/// The encoder's samples come unevenly.
Remark encoder_warning(const MotorTrack& track);
/// A sweep has few samples of the motor.
Remark sampling_warning(const MotorTrack& track, const MotorMotion& motor);
Remark slow_motor_warning(const MotorMotion& motor);
Remark few_matches_warning(std::size_t matches, std::size_t features);

}  // namespace sweepscope
