#include "core/recording/rig/detect_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/recording/assemble/assemble.hpp"
#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/assemble/mount_from_frames.hpp"
#include "core/recording/formats/read_raw_recording.hpp"
#include "core/recording/inspect.hpp"

namespace sweepscope {
namespace {

constexpr const char* kAxes = "x rolls, y tilts, z yaws";

/// Where the scanner is known to be turned by what the transforms say, the motor's angle is a joint's still;
/// only where there is no joint it is the transforms' own.
void name_turning_frame(const RawRecording& raw, const FrameMount& found, Rig& rig) {
  if (rig.motor.topic || rig.motor.joint || !found.turning) return;
  const bool others = std::ranges::any_of(raw.joints, [](const RawJoint& joint) {
    return joint.source != JointSource::kTransform && !joint.positions.empty();
  });
  if (others) return;
  rig.motor.joint = found.turning->child;
  rig.mount.axis = found.axis;
}

/// A scan that was received before its last beam can have been fired was not stamped at its first.
void judge_stamp(const Recording& recording, const LaserSummary& laser, bool given, DetectedRig& detected) {
  constexpr double kSameClock_s = 1.0;
  const auto& delay_s = recording.report.laser_stamps.receive_minus_header_s;
  if (given) {
    detected.stamp_at_note = "from the given rig file";
  } else if (recording.rig.laser.stamp != StampSource::kHeader) {
    detected.stamp_at_note = "not in the recording; receive times are arrival times";
    detected.rig.laser.stamp_at = StampAt::kArrival;
  } else if (!delay_s || *delay_s < 0 || *delay_s > kSameClock_s) {
    detected.stamp_at_note = "not in the recording; see the driver's manual";
  } else {
    const bool too_early = *delay_s < 0.95 * laser.scan_s;
    if (too_early) detected.rig.laser.stamp_at = StampAt::kLastBeam;
    detected.stamp_at_note =
        fmt::format("scans were received {:.1f} ms after their stamps and take {:.1f} ms", *delay_s * 1e3,
                    laser.scan_s * 1e3);
  }
}

void note_increment(const RawScan& first, const Recording& recording, DetectedRig& detected) {
  const double recorded_s = double{first.time_increment_s};
  if (detected.rig.laser.increment_is_found) {
    detected.increment_note = fmt::format("as the surfaces show; recorded: {:.6g}", recorded_s);
    return;
  }
  if (recorded_s != 0) {
    detected.increment_note = recording.report.beam_time_doubt_s > 0
                                  ? fmt::format("recorded: {:.6g}, implausible or ambiguous", recorded_s)
                                  : fmt::format("recorded: {:.6g}; used if that of a scan is 0", recorded_s);
    return;
  }
  if (recording.report.beam_time_doubt_s > 0) {
    detected.increment_note =
        "not recorded, and not known: scan_time / beams would be too long for a scanner with a blind sector";
  } else if (!detected.rig.laser.time_increment_s) {
    detected.rig.laser.time_increment_s = recording.scans.front().time_increment_s;
    detected.increment_note = "not recorded: scan_time / beams, too long for a scanner with a blind sector";
  } else {
    detected.increment_note = "not recorded: from the given rig file";
  }
}

void note_motor(const RawJoint& joint, const MotorSummary& motor, DetectedRig& detected) {
  detected.motor_note = fmt::format("{} samples, {:.1f} Hz, {:.1f} to {:.1f} deg", motor.used,
                                    motor.rate_hz(), motor.min_deg, motor.max_deg);
  if (motor.median_sweep_s > 0)
    detected.motor_note += fmt::format(", {:.3f} s a sweep", motor.median_sweep_s);
  if (joint.source != JointSource::kNumber || joint.positions.empty()) return;
  const auto [min, max] = std::ranges::minmax(joint.positions);
  detected.scale_note = fmt::format(
      "plain numbers, {:.6g} to {:.6g}: 0.017453292519943295 where they are degrees; measured angles, or "
      "commands?",
      min, max);
}

/// Completes the mount by the transforms, where the motor's angle is known when the first was stamped.
void take_mount(const FrameMount& found, const Recording& recording, DetectedRig& detected) {
  if (!found.turning) {
    detected.rig.mount = rig_mount(found, 0, 1);
    detected.mount_found = true;
    detected.mount_note = fmt::format("{} in {}, by transforms; the axis is not known ({})",
                                      found.chain.front(), found.chain.back(), kAxes);
    return;
  }
  const auto mount = fitted_mount(found, recording);
  if (!mount) {
    detected.mount_note = fmt::format("the transforms of {} do not fit the motor's angles: not used; {}",
                                      found.turning->child, kAxes);
    return;
  }
  detected.rig.mount = *mount;
  detected.mount_found = true;
  detected.mount_note = fmt::format("by transforms: {} turns in {}, which is the base frame; {}",
                                    found.chain.back(), found.parent, kAxes);
}

/// What is kept of a file's contents when the recording is made of it.
struct Evidence {
  RawScan first_scan;
  RawJoint joint;
  std::string laser_frame;
  std::optional<FrameMount> mount;
};

Result<Evidence> evidence_of(const RawRecording& raw, const Rig& rig) {
  const auto laser = choose_laser(raw, rig);
  if (!laser) return tl::unexpected(laser.error());
  Evidence evidence;
  const RawLaser& scans = raw.lasers[*laser];
  evidence.laser_frame = scans.frame;
  const auto with_beams = std::ranges::find_if(scans.scans, [](const auto& scan) { return scan.beams > 0; });
  if (with_beams != scans.scans.end()) evidence.first_scan = *with_beams;
  evidence.mount = mount_from_frames(raw.frames, scans.frame);
  return evidence;
}

}  // namespace

Result<DetectedRig> detect_rig(const std::filesystem::path& path, const ReadOptions& options,
                               const Job& job) {
  Rig rig = options.rig.value_or(Rig());
  auto raw = read_raw_recording(path, rig, job);
  if (!raw) return tl::unexpected(raw.error());
  auto evidence = evidence_of(*raw, rig);
  if (!evidence) return tl::unexpected(evidence.error());
  const bool mount_given = options.rig && options.rig->states_mount();
  if (evidence->mount && !mount_given) {
    name_turning_frame(*raw, *evidence->mount, rig);
    // The angle of a turning frame is that about its axis, which was not known before.
    if (rig.motor.joint && !(options.rig && options.rig->motor.joint))
      raw = read_raw_recording(path, rig, job);
    if (!raw) return tl::unexpected(raw.error());
  }
  if (!rig.motor.profile) {
    const auto joint = choose_joint(*raw, rig);
    if (!joint) return tl::unexpected(joint.error());
    evidence->joint = raw->joints[*joint];
  }
  const auto recording = assemble(std::move(*raw), rig, options.stamps);
  if (!recording) return tl::unexpected(recording.error());

  const RecordingSummary summary = inspect(*recording);
  DetectedRig detected;
  detected.rig = recording->rig;
  detected.recording = recording->name;
  for (const RecordedTopic& topic : recording->report.topics)
    if (topic.type.ends_with("/Imu") || topic.type.ends_with("/Odometry"))
      detected.motion_topics.push_back(topic);
  detected.laser_note = fmt::format("{} scans of {} beams, {:.2f} Hz{}", summary.laser.used,
                                    summary.laser.max_beams, summary.laser.rate_hz(),
                                    evidence->laser_frame.empty() ? "" : ", frame " + evidence->laser_frame);
  judge_stamp(*recording, summary.laser, options.rig && options.rig->laser.stamp_at != StampAt::kFirstBeam,
              detected);
  note_increment(evidence->first_scan, *recording, detected);
  note_motor(evidence->joint, summary.motor, detected);
  detected.mount_note = fmt::format("not in the recording: {}", kAxes);
  if (mount_given) {
    detected.mount_note = "from the given rig file";
  } else if (evidence->mount) {
    take_mount(*evidence->mount, *recording, detected);
  }
  // Nothing in a recording shows the gear.
  if (detected.rig.gear.play_deg > 0) detected.play_note = "from the given rig file";
  if (detected.rig.gear.encoder_amplitude_deg > 0) detected.encoder_note = "from the given rig file";
  return detected;
}

}  // namespace sweepscope
