#pragma once

// The mathematics: docs/algorithms.md, sections 13.3 and 14.

#include <optional>
#include <string>
#include <vector>

#include "core/offset/estimate.hpp"
#include "core/offset/search_window.hpp"
#include "core/uncertainty.hpp"

namespace sweepscope {

/// Reasons why a recording does not determine its offset, and warnings if it determines it poorly: whole
/// sentences, empty if there is nothing to report.
using Remark = std::optional<std::string>;

inline void add(std::vector<std::string>& to, const Remark& remark) {
  if (remark) to.push_back(*remark);
}

/// The minimum of a coarse curve lies at its end, a second minimum is nearly as deep, or there is none.
Remark edge_reason(const std::vector<CurvePoint>& coarse, std::size_t best);
Remark rival_reason(const std::vector<CurvePoint>& coarse, std::size_t best, const SearchScale& scale);
Remark flat_reason(const std::vector<CurvePoint>& coarse, std::size_t best);

/// The lines of a 3D scanner do not repeat, as with Livox's patterns: beams of one number point elsewhere in
/// each. For a stationary rig the direct method compares them.
Remark unrepeated_lines_reason(const Recording& recording);

/// The scans' receive times are so uneven that when each scan was taken is not known: their deviation from
/// whole periods, nine times in ten, is as much as +- a quarter of a period and more than the motor's speed
/// allows.
Remark stamps_reason(const Recording& recording, const SearchScale& scale);
/// Of the scans made while the motor was recorded, most lie in gaps of its samples.
Remark gaps_reason(const Recording& recording, const std::vector<char>& covered, double min_s, double max_s);

/// A sweep has so few samples of the motor that its motion between them decides the answer.
Remark sampling_reason(const MotorTrack& track, const MotorMotion& motor, const SearchScale& scale);

/// The scan lines fall on so few places of a sweep, again and again, that too few surfaces are seen by both
/// directions.
Remark lines_reason(double distinct_lines);

/// The clocks drift apart by more than max(1 ms, 3 sigma) over the recording, and by more than chance.
Remark drift_reason(const Trend& trend, double duration_s, double sigma_s);
/// The scene's surfaces hardly move when the motor's angle is turned: n . (a x p) is small against |a x p|.
Remark lever_reason(double lever_m, double reach_m);
/// Encoder samples per sweep; 0 if there are fewer than two samples.
double samples_per_sweep(const MotorTrack& track, const MotorMotion& motor);
/// The uncertainty from the encoder, which the scatter of the sweeps does not show because every sweep
/// repeats it: the steps of its angle, and the linear interpolation between its samples, which cuts the
/// corners of the reversals.
double encoder_step_sigma_s(const MotorTrack& track, const MotorMotion& motor);
double encoder_sampling_sigma_s(const MotorTrack& track, const MotorMotion& motor);
/// The uncertainty from surfaces measured by few lines: sweeps with the same lines have the same error.
double lines_sigma_s(const MotorMotion& motor, double distinct_lines);
/// The minimum uncertainty from scattered stamps, also if there are too few sweeps to show it: the spacings
/// of the scans show the error of each.
double stamps_sigma_s(const Recording& recording);
/// What doubt about the beams' times leaves (ReadReport::beam_time_doubt_s): the answer rests on beams from
/// the first to the last of a scan, so it may err by what the last one does.
double beam_times_sigma_s(const Recording& recording);
/// That doubt is larger than what the motor's speed should allow.
Remark beam_times_reason(const Recording& recording, const SearchScale& scale);
/// The uncertainty from the encoder, the lines and doubt about the beams' times: what the scatter of the
/// sweeps at an offset does not show.
double unseen_sigma_s(const Recording& recording, const MotorMotion& motor, double offset_s);
/// Sigma is larger than the motor's speed should allow.
Remark sigma_reason(std::optional<double> sigma_s, const SearchScale& scale);

/// The error of a part of a walk beside its own sigma, from how the parts of the walks of tuning/ in
/// tests/benchmark/walks scatter. If all its sweeps measure at the same few angles, a path that is bent in
/// the same way in each of them fits nearly as well as the true one. A path may bend more within a longer
/// sweep: the errors of walks of tests/benchmark/random_walks grow with the power 3.5 of a sweep's duration
/// beyond 0.5 s.
double unseen_of_part_s(const Recording& recording, const MotorMotion& motor, std::size_t sweeps);
/// Of a part of a walk, which is about 10 s long (JointWalkOptions::part_s).
std::size_t sweeps_of_part(const MotorMotion& motor);
/// The sweeps of a moving rig are so long that they dominate the uncertainty; with the uncertainty for
/// shorter ones. `unseen_s`: what bends of the path within the sweeps leave uncertain, of `sigma_s`.
Remark long_sweeps_warning(const Recording& recording, const MotorMotion& motor, double unseen_s,
                           double sigma_s);
/// With a motor that slows down before it turns back, a sway in step with it cannot be excluded.
Remark smooth_motor_warning(double sway_s, double sigma_s);
/// Whether the scanner has several rings, as 3D scanners do: each of their turns sees surfaces again,
/// independent of the motor.
bool has_rings(const Recording& recording);
/// Whether a sweep lasts a whole number of scans so exactly that all of this many sweeps measure at the same
/// angles.
bool sees_same_angles(const Recording& recording, const MotorMotion& motor, std::size_t sweeps);
/// All sweeps measure at the same angles: few surfaces are measured twice.
Remark aliased_warning(const Recording& recording, const MotorMotion& motor);
/// The encoder's samples are uneven in time.
Remark encoder_warning(const MotorTrack& track);
/// A sweep has few samples of the motor.
Remark sampling_warning(const MotorTrack& track, const MotorMotion& motor);
Remark slow_motor_warning(const MotorMotion& motor);
Remark few_matches_warning(std::size_t matches, std::size_t features);

}  // namespace sweepscope
