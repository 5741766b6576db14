#include "core/live/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/live/running_estimate.hpp"
#include "core/offset/kind/rig_kind.hpp"
#include "core/recording/assemble/assemble.hpp"

namespace sweepscope {
namespace {

using Clock = std::chrono::steady_clock;

std::int64_t any_stamp_ns(const MessageStamps& stamps) {
  return stamps.header_ns != 0 ? stamps.header_ns : stamps.receive_ns;
}

std::size_t scan_bytes(const RawRecording& raw) {
  std::size_t bytes = 0;
  for (const RawLaser& laser : raw.lasers)
    bytes += laser.scans.size() * sizeof(RawScan) + laser.directions.size() * sizeof(Eigen::Vector3f) +
             (laser.ranges_m.size() + laser.intensities.size()) * sizeof(float);
  return bytes;
}

bool exceeds(const RawRecording& raw, const HeardSoFar& heard, const HeardLimits& limits) {
  return heard.motor_samples > limits.motor_samples || scan_bytes(raw) > limits.scan_bytes ||
         raw.topics.size() + raw.joints.size() + raw.frames.size() > limits.names;
}

/// Since when nothing has come that brings the end nearer: a scan stamped later than all before.
class Silence {
 public:
  explicit Silence(Clock::time_point begin) : latest_(begin), newest_(begin) {}
  void hear(const HeardSoFar& heard, Clock::time_point now) {
    if (heard.scans != now_.scans || heard.motor_samples != now_.motor_samples) newest_ = now;
    now_ = heard;
    if (heard.scans == 0 || heard.seconds <= furthest_s_) return;
    furthest_s_ = heard.seconds;
    latest_ = now;
    then_ = heard;
  }
  /// None before it has lasted so long. Whether all is silent, or something still comes, shows only then: a
  /// driver that stops may send its last motor samples after its last scan.
  std::optional<ListeningEnd> ended(double after_s, Clock::time_point now) const {
    const std::chrono::duration<double> after(after_s);
    if (now - newest_ > after) return ListeningEnd::kSilence;
    if (newest_ - latest_ <= after) return std::nullopt;
    return now_.scans != then_.scans ? ListeningEnd::kStampsStandStill : ListeningEnd::kNoScans;
  }

 private:
  HeardSoFar now_, then_;
  double furthest_s_ = -1;             // the first scan is at 0
  Clock::time_point latest_, newest_;  // newest_: of anything
};

Estimate refused(const RawRecording& raw, const std::string& reason) {
  Estimate estimate;
  estimate.recording = raw.name;
  estimate.warnings = raw.warnings;
  estimate.refusals = {refusal(RefusalKind::kListeningEnded, {}, reason)};
  return estimate;
}

}  // namespace

HeardSoFar heard_so_far(const RawRecording& raw) {
  HeardSoFar heard;
  for (const RawLaser& laser : raw.lasers) {
    if (laser.scans.size() <= heard.scans) continue;
    heard.scans = laser.scans.size();
    heard.seconds = static_cast<double>(any_stamp_ns(laser.scans.back().stamps) -
                                        any_stamp_ns(laser.scans.front().stamps)) *
                    1e-9;
  }
  for (const RawJoint& joint : raw.joints) heard.motor_samples += joint.stamps.size();
  return heard;
}

HeardLimits limits_of(const CalibrationOptions& options) {
  // A spinning scanner of 128 lines sends 20 MB/s, a scanner of one line less than 1 MB/s, a motor 1000
  // samples/s, and before the first scan as well.
  constexpr double kScans_bytes_per_s = 32e6, kMaxScans_bytes = 512e6;
  constexpr double kSamples_per_s = 20e3, kMaxSamples = 10e6;
  constexpr std::size_t kMaxNames = 10'000;
  return {
      static_cast<std::size_t>(std::min(kMaxScans_bytes, kScans_bytes_per_s * options.seconds)),
      static_cast<std::size_t>(std::min(kMaxSamples, kSamples_per_s * (options.seconds + options.silence_s))),
      kMaxNames};
}

Result<ListeningEnd> listen(
    LiveSource& source, const CalibrationOptions& options, const Job& job,
    const std::function<void(const HeardSoFar& heard, const Result<Estimate>& answer)>& tell) {
  constexpr std::chrono::milliseconds kAtATime(50);
  RunningEstimate running;
  const HeardLimits limits = limits_of(options);
  Silence silence(options.now());
  double next_answer_s = options.every_s;
  while (!job.cancelled()) {
    const auto more = source.listen(kAtATime);
    if (!more) return tl::unexpected(more.error());
    const HeardSoFar heard = heard_so_far(source.so_far());
    const Clock::time_point now = options.now();
    silence.hear(heard, now);
    job.report("listening", heard.seconds / options.seconds);
    if (heard.seconds >= options.seconds) return ListeningEnd::kHeardEnough;
    if (!*more) return ListeningEnd::kInputEnded;
    if (exceeds(source.so_far(), heard, limits)) return ListeningEnd::kTooMuch;
    if (const auto end = silence.ended(options.silence_s, now)) return *end;
    if (const auto answer = running.take()) tell(running.about(), *answer);
    if (running.idle() && heard.seconds >= next_answer_s) {
      running.begin(source.heard(), options);
      next_answer_s = heard.seconds + options.every_s;
    }
  }
  return ListeningEnd::kCancelled;
}

/// Streams that the rig does not name are not kept: others may well have been received.
std::string none_received(const std::string& what, const std::optional<std::string>& topic,
                          const std::optional<std::string>& joint) {
  return "No " + what + (joint ? " of the joint " + *joint : "") + " were received" +
         (topic ? " on " + *topic : "") + ".";
}

Result<Estimate> calibrate(RawRecording heard, const CalibrationOptions& options, const Job& job) {
  const HeardSoFar so_far = heard_so_far(heard);
  if (so_far.scans == 0) return refused(heard, none_received("scans", options.rig.laser.topic));
  if (so_far.motor_samples == 0)
    return refused(heard, none_received("motor angles", options.rig.motor.topic, options.rig.motor.joint));
  const auto recording = assemble(std::move(heard), options.rig, options.stamps);
  if (!recording) return tl::unexpected(recording.error());
  const auto prepared = prepare(*recording, options.estimate.features, job);
  if (!prepared) return tl::unexpected(prepared.error());
  const MotionTest motion = test_motion(*prepared);
  const bool moved = motion.answered() && motion.moving();
  EstimateOptions estimate_options = options.estimate;
  estimate_options.assume = RigKind::kStationary;
  auto found = estimate(*prepared, estimate_options, {}, job);
  if (!found || !motion.answered()) return found;
  if (found->kind) {
    found->kind = moved ? RigKind::kMoving : RigKind::kStationary;
    found->kind_reason = pairs_text(motion);
  }
  if (moved) {
    found->refusals.push_back(refusal(RefusalKind::kCalibrationMoved, {}));
    found->identifiable = false;
    found->offset_s.reset();
    found->sigma_s.reset();
  }
  return found;
}

}  // namespace sweepscope
