#pragma once

// The mathematics: docs/algorithms.md, section 13.3.

#include <cstddef>
#include <vector>

#include "core/recording/recording.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// Encoder samples per sweep; 0 if there are fewer than two samples.
double samples_per_sweep(const MotorTrack& track, const MotorMotion& motor);
/// Scans per sweep; 0 if there are fewer than two scans.
double scans_a_sweep(const Recording& recording, const MotorMotion& motor);
/// Scan lines per sweep: of a motor that goes in steps and rests those of a rest are one.
double lines_a_sweep(const Recording& recording, const MotorMotion& motor);
/// A 2D scanner makes fewer than 12 scan lines a sweep, as one of 10 Hz does on sweeps of a second.
bool has_sparse_sweeps(const Recording& recording, const MotorMotion& motor);
/// A 2D scanner makes fewer scan lines a sweep than kLimits.min_lines_a_sweep: parts of sweeps are too few to
/// be compared.
bool has_few_lines(const Recording& recording, const MotorMotion& motor);
/// The uncertainty from the encoder, which the scatter of the sweeps does not show because every sweep
/// repeats it: the steps of its angle, and the linear interpolation between its samples, which cuts the
/// corners of the reversals.
double encoder_step_sigma_s(const MotorTrack& track, const MotorMotion& motor);
double encoder_sampling_sigma_s(const MotorTrack& track, const MotorMotion& motor);
/// Of a motor in steps with an encoder: when it leaves a rest is known to a sample, evenly distributed, at
/// each step. 0 of other motors.
double rests_sigma_s(const Recording& recording, const MotorMotion& motor);
/// The uncertainty from surfaces measured by few lines: sweeps with the same lines have the same error.
double lines_sigma_s(const MotorMotion& motor, double distinct_lines);
/// The minimum uncertainty from scattered stamps, also if there are too few sweeps to show it: the spacings
/// of the scans show the error of each.
double stamps_sigma_s(const Recording& recording);
/// What doubt about the beams' times leaves (ReadReport::beam_time_doubt_s): the answer rests on beams from
/// the first to the last of a scan, so it may err by what the last one does.
double beam_times_sigma_s(const Recording& recording);
/// The uncertainty from the encoder or a profile's speed, the lines and doubt about the beams' times: what
/// the scatter of the sweeps at an offset does not show.
double unseen_sigma_s(const Recording& recording, const MotorMotion& motor, double offset_s);

/// Sweeps of walks that are shorter than this leave no less in doubt.
inline constexpr double kShortSweep_s = 0.5;
/// The error of a part of a walk beside its own sigma, from how the parts of the walks of tuning/ in
/// tests/benchmark/walks scatter. If all its sweeps measure at the same few angles, a path that is bent in
/// the same way in each of them fits nearly as well as the true one. A path may bend more within a longer
/// sweep: the errors of walks of tests/benchmark/random_walks grow with the power 3.5 of a sweep's duration
/// beyond 0.5 s.
double unseen_of_part_s(const Recording& recording, const MotorMotion& motor, std::size_t sweeps);
/// What sweeps of kShortSweep_s would leave, where these leave `unseen_s`.
double unseen_of_short_sweeps_s(const Recording& recording, const MotorMotion& motor, double unseen_s);
/// Of a part of a walk, which is about 10 s long (JointWalkOptions::part_s).
std::size_t sweeps_of_part(const MotorMotion& motor);
/// Whether the scanner has several rings, as 3D scanners do: each of their turns sees surfaces again,
/// independent of the motor.
bool has_rings(const Recording& recording);
/// Whether a sweep lasts a whole number of scans so exactly that all of this many sweeps measure at the same
/// angles.
bool sees_same_angles(const Recording& recording, const MotorMotion& motor, std::size_t sweeps);

}  // namespace sweepscope
