#include "core/recording/assemble/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/numbers.hpp"
#include "core/recording/assemble/beam_times.hpp"
#include "core/recording/assemble/choose_streams.hpp"
#include "core/recording/assemble/motor_samples.hpp"
#include "core/recording/assemble/mount_from_frames.hpp"
#include "core/recording/assemble/turns.hpp"
#include "core/recording/stream_stamps.hpp"

namespace sweepscope {
namespace {

constexpr double kScanGapFactor = 1.5;

double since_s(std::int64_t ns, std::int64_t epoch_ns) {
  return static_cast<double>(ns - epoch_ns) * 1e-9;
}

/// Refuses a scan of more beams than can be distinguished.
std::optional<Error> too_many_beams(const RawRecording& raw, const RawLaser& laser) {
  for (std::size_t i = 0; i < laser.scans.size(); ++i) {
    if (laser.scans[i].beams <= kMaxBeamsAScan) continue;
    return Error{ExitCode::kUnreadableInput,
                 fmt::format("{}: scan {} on {} has {} beams; at most {} are supported", raw.file, i + 1,
                             laser.topic, laser.scans[i].beams, kMaxBeamsAScan)};
  }
  return std::nullopt;
}

/// Turns raw scans into those of the recording.
class ScanAssembler {
 public:
  ScanAssembler(RawLaser& raw, Recording& recording)
      : raw_(raw), recording_(recording), report_(recording.report) {}

  /// False where no scan is usable.
  bool assemble();
  std::string reason() const;

 private:
  void turn_round(RawScan& scan);
  bool place(const RawScan& raw, LaserScan& scan);
  void set_epoch();
  bool check_cloud_times(const std::vector<LaserScan>& lines);
  void order_lines(std::vector<LaserScan>& lines);
  void take_ranges();
  void put_together(bool timed);
  /// Only the scans' headers were read.
  bool without_ranges() const { return raw_.ranges_m.empty(); }
  void clean(const RawScan& raw, std::span<float> ranges_m);
  void warn_of_drops();
  void warn_of_overlap();

  RawLaser& raw_;
  Recording& recording_;
  ReadReport& report_;
  std::vector<double> cloud_spans_s_;  // of the lines placed
  std::string cloud_problem_;
  double turns_ = 1;     // of the mirror, from message to message
  double period_s_ = 0;  // of a turn of the mirror; 0 where it is not known
  BeamTimesReport beam_times_;
  std::size_t without_stamp_ = 0, without_beams_ = 0;
};

/// The whole second at or before the first scan: near enough for times in double precision.
void ScanAssembler::set_epoch() {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  for (const RawScan& scan : raw_.scans) {
    const std::int64_t ns = stamp_ns(scan.stamps, report_.laser_stamps.used);
    if (ns != 0) first_ns = std::min(first_ns, ns);
  }
  recording_.epoch_ns = first_ns - first_ns % kSecond_ns;
}

/// A scan whose beams were fired from the last to the first, in the order of time.
void ScanAssembler::turn_round(RawScan& scan) {
  const auto reverse = [&](std::vector<float>& of_beams) {
    const auto first = of_beams.begin() + static_cast<std::ptrdiff_t>(scan.first_range);
    std::reverse(first, first + scan.beams);
  };
  if (!without_ranges()) reverse(raw_.ranges_m);
  if (raw_.has_intensities) reverse(raw_.intensities);
  scan.angle_min_rad = last_beam_angle_rad(scan);
  scan.angle_increment_rad = -scan.angle_increment_rad;
  const bool recorded = scan.time_increment_s < 0;
  scan.time_increment_s = std::abs(scan.time_increment_s);
  // Where only the message says so, its stamp is that of its first beam, the last one fired.
  const bool of_message = recorded && !(recording_.rig.laser.time_increment_s.value_or(0) < 0);
  if (of_message && recording_.rig.laser.stamp_at == StampAt::kFirstBeam)
    scan.first_beam_after_stamp_s = -(scan.beams - 1.0) * double{scan.time_increment_s};
}

/// When and where a scan's beams went; false, and counted, where that cannot be said.
bool ScanAssembler::place(const RawScan& raw, LaserScan& scan) {
  const std::int64_t ns = stamp_ns(raw.stamps, report_.laser_stamps.used);
  if (ns == 0) return ++without_stamp_, false;
  const bool one_direction = raw.angle_increment_rad == 0 && raw.beams > 1;
  if (raw.beams == 0 || one_direction || !std::isfinite(raw.angle_min_rad) ||
      !std::isfinite(raw.angle_increment_rad)) {
    return ++without_beams_, false;
  }
  scan.beams = raw.beams;
  scan.angle_min_rad = double{raw.angle_min_rad};
  scan.angle_increment_rad = double{raw.angle_increment_rad};
  scan.first_range = raw.first_range;
  std::optional<double> rig_increment_s = recording_.rig.laser.time_increment_s;
  if (rig_increment_s) rig_increment_s = std::abs(*rig_increment_s);
  // The times of a cloud's points have a check of their own.
  if (raw_.of_clouds && usable_increment(double{raw.time_increment_s})) rig_increment_s.reset();
  const BeamTimes times = judge_beam_times(raw, raw_.of_clouds ? 0 : period_s_, rig_increment_s, turns_);
  beam_times_.add(raw, times, recording_.rig.laser.increment_is_found);
  if (!times.time_increment_s) return false;
  scan.time_increment_s = *times.time_increment_s;
  scan.ring = raw.ring;
  const double stamp_s = since_s(ns, recording_.epoch_ns);
  const bool first = recording_.rig.laser.stamp_at == StampAt::kFirstBeam;
  const double end_s =
      raw_.of_clouds ? raw.cloud_end_after_stamp_s : (raw.beams - 1.0) * scan.time_increment_s;
  const bool turned_round = !raw_.of_clouds && raw.first_beam_after_stamp_s < 0;
  const double after_stamp_s = turned_round ? -end_s : raw.first_beam_after_stamp_s;
  scan.first_beam_s = stamp_s + after_stamp_s - (first ? 0 : end_s);
  return true;
}

bool ScanAssembler::assemble() {
  set_epoch();
  const MessageTurns turns = raw_.of_clouds ? MessageTurns() : turns_of_messages(raw_.scans);
  turns_ = turns.per_message;
  period_s_ = scan_period_s(raw_.scans, report_.laser_stamps.used) / turns_;
  std::vector<LaserScan> placed;
  std::vector<double> times_s;
  for (RawScan& raw : raw_.scans) {
    LaserScan scan;
    const std::optional<double>& of_rig = recording_.rig.laser.time_increment_s;
    const bool backwards = !raw_.of_clouds && (fired_backwards(raw, of_rig) || (turns.backwards && !of_rig));
    if (backwards) turn_round(raw);
    report_.fired_backwards = report_.fired_backwards || backwards;
    if (!place(raw, scan)) {
      ++report_.scans_dropped;
      continue;
    }
    if (!without_ranges()) clean(raw, std::span(raw_.ranges_m).subspan(raw.first_range, raw.beams));
    placed.push_back(scan);
    times_s.push_back(scan.first_beam_s);
    if (raw_.of_clouds) cloud_spans_s_.push_back(raw.cloud_end_after_stamp_s - raw.first_beam_after_stamp_s);
  }
  if (placed.empty()) return false;
  if (raw_.of_clouds) {
    if (!check_cloud_times(placed)) return false;
    order_lines(placed);
  } else {
    const TimeOrder order = order_by_time(times_s);
    report_.scans_out_of_order = order.out_of_order;
    report_.scans_duplicate = order.duplicates;
    const auto clock = part_of_one_clock(times_s);
    if (clock) report_.warnings.push_back(set_back_warning(*clock, times_s[order.kept[0]], raw_.topic));
    for (const std::size_t i : order.kept)
      if (!clock || (times_s[i] >= clock->from_s && times_s[i] <= clock->to_s))
        recording_.scans.push_back(placed[i]);
  }
  if (!without_ranges()) take_ranges();
  // Without increments the beams of each part may be of one instant.
  const bool timed = recording_.rig.laser.time_increment_s ||
                     usable_increment(std::abs(double{raw_.scans.front().time_increment_s}));
  if (turns_ != 1 && !recording_.ranges_m.empty()) put_together(timed);
  warn_of_drops();
  warn_of_overlap();
  return true;
}

/// Drivers have many units for the times of points. One misread shows, since a cloud takes about as long as
/// from it to the next: false where it takes another time altogether.
bool ScanAssembler::check_cloud_times(const std::vector<LaserScan>& lines) {
  constexpr double kMinPart = 0.02, kMaxPart = 50;
  const std::uint16_t ring = std::ranges::min(lines, {}, &LaserScan::ring).ring;
  std::vector<double> times_s, spans_s;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].ring != ring) continue;
    times_s.push_back(lines[i].first_beam_s);
    spans_s.push_back(cloud_spans_s_[i]);
  }
  std::ranges::sort(times_s);
  const double period_s = spacing(times_s, kScanGapFactor).median_s, span_s = median(spans_s);
  if (times_s.size() < 3 || !(period_s > 0)) return true;
  if (span_s > kMinPart * period_s && span_s < kMaxPart * period_s) return true;
  cloud_problem_ = fmt::format(
      "the times of a cloud's points span {:.3g} s, but clouds are {:.3g} s apart: the unit of the times is "
      "not known",
      span_s, period_s);
  return false;
}

/// The lines of clouds in the order of time: rings may begin at one instant, a ring has no two lines there.
void ScanAssembler::order_lines(std::vector<LaserScan>& lines) {
  std::map<std::uint16_t, double> latest_s;
  for (const LaserScan& line : lines) {
    const auto [found, is_new] = latest_s.try_emplace(line.ring, line.first_beam_s);
    if (!is_new && line.first_beam_s < found->second) ++report_.scans_out_of_order;
    found->second = std::max(found->second, line.first_beam_s);
  }
  const auto key = [](const LaserScan& line) { return std::pair(line.first_beam_s, line.ring); };
  std::ranges::stable_sort(lines, {}, key);
  for (const LaserScan& line : lines) {
    if (!recording_.scans.empty() && key(recording_.scans.back()) == key(line))
      ++report_.scans_duplicate;
    else
      recording_.scans.push_back(line);
  }
}

/// Marks what is no range with NaN, and counts it by its kind.
void ScanAssembler::clean(const RawScan& raw, std::span<float> ranges_m) {
  const float max_m = raw.range_max_m > 0 ? raw.range_max_m : std::numeric_limits<float>::infinity();
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  for (float& range_m : ranges_m) {
    if (std::isnan(range_m)) {
      ++report_.nan_ranges;
    } else if (std::isinf(range_m)) {
      ++report_.infinite_ranges;
      range_m = kNothing;
    } else if (range_m == 0) {
      ++report_.zero_ranges;
      range_m = kNothing;
    } else if (range_m < 0 || range_m < raw.range_min_m || range_m > max_m) {
      ++report_.out_of_range_ranges;
      range_m = kNothing;
    }
  }
}

/// Moves the ranges where they lie in order already, else gathers them scan by scan.
void ScanAssembler::take_ranges() {
  std::size_t next = 0;
  bool in_order = true;
  for (const LaserScan& scan : recording_.scans) {
    in_order = in_order && scan.first_range == next;
    next += scan.beams;
  }
  const bool intensities = raw_.has_intensities;
  if (in_order && next == raw_.ranges_m.size()) {
    recording_.ranges_m = std::move(raw_.ranges_m);
    if (intensities) recording_.intensities = std::move(raw_.intensities);
    recording_.directions = std::move(raw_.directions);
    return;
  }
  recording_.ranges_m.reserve(next);
  if (intensities) recording_.intensities.reserve(next);
  for (LaserScan& scan : recording_.scans) {
    const auto append = [&](const auto& from, auto& to) {
      const auto first = from.begin() + static_cast<std::ptrdiff_t>(scan.first_range);
      to.insert(to.end(), first, first + scan.beams);
    };
    const std::size_t first_range = recording_.ranges_m.size();
    append(raw_.ranges_m, recording_.ranges_m);
    if (intensities) append(raw_.intensities, recording_.intensities);
    if (!raw_.directions.empty()) append(raw_.directions, recording_.directions);
    scan.first_range = first_range;
  }
}

/// Messages that cover parts of a turn, as whole turns.
void ScanAssembler::put_together(bool timed) {
  const std::size_t messages = recording_.scans.size();
  std::vector<LaserScan> turns = timed ? whole_turns(recording_.scans) : recording_.scans;
  if (turns.size() == messages) {
    report_.warnings.push_back(fmt::format(
        "the {} messages on {} cover parts of a turn of the mirror, and by the times of their beams they do "
        "not follow each other, so they are not put together (give laser.time_increment_s in a rig file)",
        messages, raw_.topic));
    return;
  }
  recording_.scans = std::move(turns);
  report_.warnings.push_back(
      fmt::format("the {} messages on {} cover parts of a turn of the mirror: they are read as {} turns",
                  messages, raw_.topic, recording_.scans.size()));
}

std::string ScanAssembler::reason() const {
  std::vector<std::string> reasons;
  if (!cloud_problem_.empty()) reasons.push_back(cloud_problem_);
  if (without_stamp_ > 0) reasons.push_back(fmt::format("{} have no stamp", without_stamp_));
  if (without_beams_ > 0) reasons.push_back(fmt::format("{} have no beams with directions", without_beams_));
  if (std::string without_increment = beam_times_.unusable(); !without_increment.empty())
    reasons.push_back(std::move(without_increment));
  return fmt::format("{}", fmt::join(reasons, ", "));
}

void ScanAssembler::warn_of_drops() {
  if (report_.scans_dropped > 0) {
    report_.warnings.push_back(fmt::format("{} of {} scans on {} were dropped: {}", report_.scans_dropped,
                                           raw_.scans.size(), raw_.topic, reason()));
  }
  for (std::string& warning : beam_times_.warnings(raw_.topic, period_s_))
    report_.warnings.push_back(std::move(warning));
  report_.beam_time_doubt_s = beam_times_.doubt_s();
}

void ScanAssembler::warn_of_overlap() {
  std::vector<double> times_s, durations_s;
  for (const LaserScan& scan : recording_.scans) {
    if (scan.ring != recording_.scans.front().ring) continue;
    times_s.push_back(scan.first_beam_s);
    durations_s.push_back(scan.last_beam_s() - scan.first_beam_s);
  }
  const Spacing spaced = spacing(times_s, kScanGapFactor);
  report_.laser_stamps.median_period_s = spaced.median_s;
  report_.scan_gaps = spaced.gaps;
  report_.longest_scan_gap_s = spaced.longest_gap_s;
  const double duration_s = median(durations_s);
  if (times_s.size() > 2 && duration_s > 1.05 * spaced.median_s) {
    report_.warnings.push_back(
        fmt::format("a scan on {} takes {:.4g} s by its time_increment, and scans follow every {:.4g} s: its "
                    "time_increment is too long, or scans are duplicated",
                    raw_.topic, duration_s, spaced.median_s));
  }
}

/// How the two streams fit together at offset 0.
void compare_streams(Recording& recording) {
  ReadReport& report = recording.report;
  const MotorTrack& motor = recording.motor;
  const double longest_gap_s = kMotorGapFactor * report.motor_stamps.median_period_s;
  for (const LaserScan& scan : recording.scans) {
    if (!motor.covers(scan.first_beam_s, scan.last_beam_s(), longest_gap_s)) ++report.scans_without_motor;
  }
  if (report.laser_stamps.used != report.motor_stamps.used) {
    const bool laser_by_header = report.laser_stamps.used == StampSource::kHeader;
    report.warnings.push_back(fmt::format(
        "the laser uses {} and the motor {}: the offset then includes the delays of this recording",
        laser_by_header ? "header stamps" : "receive times",
        laser_by_header ? "receive times" : "header stamps"));
  }
  const double start_s = recording.scans.front().first_beam_s, end_s = recording.scans.back().last_beam_s();
  if (motor.time_s.front() > end_s || motor.time_s.back() < start_s) {
    report.warnings.push_back(fmt::format(
        "the two streams' clocks do not overlap: the scans last {:.3f} s, and the motor's samples lie from "
        "{:.3f} to {:.3f} s after the first scan; try the receive times (--stamps receive)",
        end_s - start_s, motor.time_s.front() - start_s, motor.time_s.back() - start_s));
  } else if (20 * report.scans_without_motor > recording.scans.size()) {
    report.warnings.push_back(fmt::format("{} of {} scans have no motor samples around them",
                                          report.scans_without_motor, recording.scans.size()));
  }
}

/// Receive times of messages that came late are corrected, if receive times are used.
void correct_late(std::span<MessageStamps> stamps, const StreamStamps& stream, const std::string& topic,
                  std::vector<std::string>& warnings) {
  if (stream.used != StampSource::kReceive) return;
  const LateMessages late = correct_late(stamps);
  if (late.count == 0) return;
  warnings.push_back(
      fmt::format("{} of {} messages on {} were received up to {:.0f} ms late: their receive times are "
                  "corrected by the header stamps",
                  late.count, stamps.size(), topic, late.latest_s * 1e3));
}

StampSource stamps_wanted(const std::optional<StampSource>& of_rig, std::optional<StampSource> stamps) {
  return stamps.value_or(of_rig.value_or(StampSource::kHeader));
}

/// The laser's stamps, and the rig completed by them.
void choose_laser_stamps(RawLaser& laser, std::optional<StampSource> stamps, Recording& recording) {
  Rig& rig = recording.rig;
  ReadReport& report = recording.report;
  std::vector<MessageStamps> of_scans;
  for (const RawScan& scan : laser.scans) of_scans.push_back(scan.stamps);
  report.laser_stamps =
      choose_stamps(of_scans, stamps_wanted(rig.laser.stamp, stamps), laser.topic, report.warnings);
  correct_late(of_scans, report.laser_stamps, laser.topic, report.warnings);
  for (std::size_t i = 0; i < of_scans.size(); ++i) laser.scans[i].stamps = of_scans[i];
  rig.laser.topic = laser.topic;
  rig.laser.stamp = report.laser_stamps.used;
}

/// The same of the motor.
void choose_motor_stamps(RawJoint& joint, std::optional<StampSource> stamps, Recording& recording) {
  Rig& rig = recording.rig;
  ReadReport& report = recording.report;
  report.motor_stamps =
      choose_stamps(joint.stamps, stamps_wanted(rig.motor.stamp, stamps), joint.topic, report.warnings);
  correct_late(joint.stamps, report.motor_stamps, joint.topic, report.warnings);
  rig.motor.topic = joint.topic;
  rig.motor.joint = joint.joint;
  rig.motor.stamp = report.motor_stamps.used;
}

/// The mount that the recording's transforms state, where the rig states none.
void take_mount_of_frames(const RawRecording& raw, const RawLaser& laser, const RawJoint& joint,
                          Recording& recording) {
  if (recording.rig.states_mount() || joint.source == JointSource::kTransform) return;
  const auto found = mount_from_frames(raw.frames, laser.frame);
  const auto mount = found ? fitted_mount(*found, recording) : std::nullopt;
  if (!mount) return;
  recording.rig.mount = *mount;
  recording.report.warnings.push_back(fmt::format(
      "the laser's mount is that of the recording's transforms: {} turns in {} about [{:.3g}, {:.3g}, {:.3g}]; give "
      "mount in a rig file to state another",
      found->chain.back(), found->parent, mount->axis.x(), mount->axis.y(), mount->axis.z()));
}

}  // namespace

Result<Recording> assemble(RawRecording raw, const Rig& rig, std::optional<StampSource> stamps) {
  const auto laser = choose_laser(raw, rig);
  if (!laser) return tl::unexpected(laser.error());
  RawLaser& raw_laser = raw.lasers[*laser];
  if (auto error = too_many_beams(raw, raw_laser)) return tl::unexpected(std::move(*error));
  RawJoint* raw_joint = nullptr;  // a motor without an encoder has none
  if (!rig.motor.profile) {
    const auto joint = choose_joint(raw, rig);
    if (!joint) return tl::unexpected(joint.error());
    raw_joint = &raw.joints[*joint];
  }

  Recording recording;
  recording.name = raw.name;
  recording.rig = rig;
  recording.report.topics = std::move(raw.topics);
  recording.report.warnings = std::move(raw.warnings);
  if (raw_joint != nullptr && !rig.motor.index) warn_of_source(*raw_joint, recording);
  warn_of_frames(raw_laser, recording);
  choose_laser_stamps(raw_laser, stamps, recording);
  if (raw_joint != nullptr) choose_motor_stamps(*raw_joint, stamps, recording);
  ScanAssembler scans(raw_laser, recording);
  if (!scans.assemble()) {
    return unreadable(fmt::format("{}: none of the {} scans on {} can be used: {}", raw.file,
                                  raw_laser.scans.size(), raw_laser.topic, scans.reason()));
  }
  if (raw_joint == nullptr) {
    recording.report.motor_stamps.used = recording.report.laser_stamps.used;
    assemble_profile(recording);
  } else if (!(rig.motor.index ? assemble_index(*raw_joint, recording)
                               : assemble_motor(*raw_joint, recording))) {
    return unreadable(fmt::format("{}: joint {} on {} has {} usable samples; at least two are needed",
                                  raw.file, raw_joint->joint, raw_joint->topic,
                                  recording.motor.time_s.size()));
  }
  if (raw_joint != nullptr) take_mount_of_frames(raw, raw_laser, *raw_joint, recording);
  compare_streams(recording);
  assemble_motion(raw, recording);
  return recording;
}

}  // namespace sweepscope
