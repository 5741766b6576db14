#include "core/offset/summary.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/judgement/unseen_sigma.hpp"
#include "core/offset/judgement/warnings.hpp"
#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/offset/search/stationary_part.hpp"

namespace sweepscope {
namespace {

// What stands in the way of any estimate; empty where nothing does.
std::vector<std::string> obstacles(const LaserSummary& laser, const MotorSummary& motor,
                                   const MotorTrack& track, const MotorMotion& motion) {
  if (!motor.turns) return {"The motor does not turn, so there is no offset to determine."};
  if (motor.one_way)
    if (const auto refused = motor_refusal(track, motion)) return {refused->text};
  if (motor.reversals == 0 && !motor.one_way)
    return {"The motor never turns back, so there are no two sweeps to compare."};
  if (laser.used == laser.scans_without_motor)
    return {"No scan has motor samples around it at offset 0: use other stamps."};
  return {};
}

// Why an estimate will be refused whatever the scans show.
Remark expected_refusal(const Recording& recording, const MotorMotion& motor) {
  const SearchScale scale = search_scale(motor);
  for (const MaybeRefusal& refused :
       {scan_times_refusal(recording, scale), beam_times_refusal(recording, scale),
        samples_refusal(recording.motor, motor, scale), lines_refusal(distinct_lines(recording, motor, 0))}) {
    if (!refused) continue;
    std::string text = refused->text;
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
    return "Expect a refusal: " + text;
  }
  return std::nullopt;
}

// What the encoder, its samples and the scan lines leave uncertain at best, and on a walk of 40 s what bends
// of the path within the sweeps leave besides.
std::string accuracy(const Recording& recording, const MotorMotion& motor) {
  constexpr double kParts = 4;  // of a walk of 40 s, see JointWalkOptions::part_s
  const double stationary_s = unseen_sigma_s(recording, motor, 0);
  if (motor.one_way())
    return fmt::format(
        "The motor turns one way, at speeds that differ by {:.3g} deg/s: expect an accuracy of about {:.2g} "
        "ms for a stationary rig. A moving one is refused.",
        motor.speeds_apart_rad_s() / kRadPerDeg, 1e3 * std::max(stationary_s, 0.01e-3));
  const double of_part_s = unseen_of_part_s(recording, motor, sweeps_of_part(motor));
  return fmt::format(
      "Expect an accuracy of about {:.2g} ms for a stationary rig and {:.2g} ms for a moving one (40 s).",
      1e3 * std::max(stationary_s, 0.01e-3), 1e3 * std::hypot(stationary_s, of_part_s / std::sqrt(kParts)));
}

Remark sparse_samples(const Recording& recording, const MotorMotion& motor) {
  constexpr double kEnough = 16;  // a sweep: 2 T n^-5 is a microsecond of 0.5 s then
  if (!sampling_warning(recording.motor, motor)) return std::nullopt;
  return fmt::format(
      "The motor is sampled only {:.1f} times per sweep, which reduces the accuracy: sample it every {:.2g} "
      "s.",
      samples_per_sweep(recording.motor, motor), motor.median_sweep_s / kEnough);
}

Remark few_sweeps(std::size_t sweeps) {
  // The 4 s of the paper's stationary sets, and the 20 s below which a walk's answer comes with a warning, in
  // sweeps of 0.5 s.
  constexpr std::size_t kStationary = 8, kMoving = 40;
  if (sweeps < kStationary)
    return fmt::format(
        "Only {} whole sweep{}: a good recording has {} for a stationary rig or {} for a moving one.", sweeps,
        sweeps == 1 ? "" : "s", kStationary, kMoving);
  if (sweeps < kMoving)
    return fmt::format("{} whole sweeps are enough for a stationary rig; a moving one should have {}.",
                       sweeps, kMoving);
  return std::nullopt;
}

}  // namespace

std::vector<std::string> expectations(const Recording& recording, const RecordingSummary& summary,
                                      const MotorMotion& motor) {
  const LaserSummary& laser = summary.laser;
  std::vector<std::string> lines = obstacles(laser, summary.motor, recording.motor, motor);
  if (!lines.empty()) return lines;
  const auto add = [&](const Remark& line) {
    if (line) lines.push_back(*line);
  };
  const double deg_per_ms = summary.motor.deg_per_ms();
  add(fmt::format("1 ms of offset turns a scan by {:.3g} deg: {:.2g} mm at the median range of {:.3g} m.",
                  deg_per_ms, laser.median_range_m * deg_per_ms * kRadPerDeg * 1000, laser.median_range_m));
  const Remark refused = expected_refusal(recording, motor);
  add(refused ? *refused : accuracy(recording, motor));
  if (!motor.one_way())
    add(fmt::format("Offsets up to {:.4g} ms to either side can be distinguished ({}).",
                    1e3 * search_scale(motor).max_half_width_s,
                    motor.mirror_shift_s > motor.median_sweep_s
                        ? "more than a quarter of the motor's period, since its motion is not even"
                        : "a quarter of the motor's period"));
  if (!refused) add(sparse_samples(recording, motor));
  if (!motor.one_way()) add(few_sweeps(summary.motor.whole_sweeps()));
  for (const auto& [stream, name] :
       {std::pair<const StreamSummary&, const char*>{laser, "scans'"}, {summary.motor, "motor's"}}) {
    if (stream.stamp != StampSource::kReceive || !stream.receive_jitter_s) continue;
    add(fmt::format("The {} receive times jitter by {:.2g} ms, which reduces the accuracy.", name,
                    1000 * *stream.receive_jitter_s));
  }
  return lines;
}

Result<RecordingSummary> summarise(const Recording& recording, const Job& job) {
  RecordingSummary summary = inspect(recording);
  const auto prepared = prepare(recording, FeatureOptions(), job);
  if (!prepared) return tl::unexpected(prepared.error());
  const MotionTest motion = test_motion(*prepared);
  if (motion.answered()) summary.motion = motion.moving() ? "moving" : "stationary";
  if (motion.moving()) summary.stationary_part = motion_course(*prepared, job).stationary;
  summary.expectations = expectations(recording, summary, prepared->motor);
  return summary;
}

}  // namespace sweepscope
