#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

/// The maximum number of beams of a scan: features count them in 16 bits.
inline constexpr std::uint32_t kMaxBeamsAScan = 65'536;

/// One scan line of the laser. Beam i was fired at `first_beam_s + i * time_increment_s`, in the direction
/// `angle_min_rad + i * angle_increment_rad` about the laser's z axis, 0 along its x axis. Of a 3D scanner a
/// line is one ring of one turn, or a slice of time; these angles then give the spacing of its beams, and
/// Recording::direction() their directions.
struct LaserScan {
  double first_beam_s = 0;         // laser clock, seconds since Recording::epoch_ns
  double time_increment_s = 0;     // >= 0; 0: all beams at one instant
  double angle_min_rad = 0;        // of beam 0
  double angle_increment_rad = 0;  // from beam to beam
  std::size_t first_range = 0;     // index of beam 0 in Recording::ranges_m
  std::uint32_t beams = 0;         // with or without a return
  std::uint16_t ring = 0;          // of a 3D scanner with rings, from 0; else 0

  /// When beam i was fired, on the laser's clock.
  double beam_s(double beam) const { return first_beam_s + beam * time_increment_s; }
  /// The direction of beam i of a 2D scanner.
  double beam_angle_rad(double beam) const { return angle_min_rad + beam * angle_increment_rad; }
  /// When the last beam was fired.
  double last_beam_s() const { return beam_s(beams - 1.0); }
};

/// An IMU's gyroscope: the base frame's angular velocity, in the base frame. Times are strictly ascending.
struct TurnRates {
  std::vector<double> time_s;               // as stamped, seconds since Recording::epoch_ns
  std::vector<Eigen::Vector3d> rate_rad_s;  // one for each time
};

/// A topic of the recording's file, used or not.
struct RecordedTopic {
  std::string name;           // such as /scan
  std::string type;           // of its messages, as the file names it
  std::size_t messages = 0;   // of them all
  std::size_t malformed = 0;  // of those, not decodable and skipped
};

/// How the beams of a message follow each other in time: see core/offset/readings.
enum class BeamReadingKind {
  kRecorded,
  kReversed,  // the last beam of the array was fired first
  kAtOnce,
  kMirror,  // the mirror turns once from scan to scan
  kMirrorReversed,
  kPeriod,  // a scan takes all of the time from scan to scan
  kPeriodReversed
};
/// A reading, and how well sweeps of opposite directions fit each other by it.
struct BeamReading {
  BeamReadingKind kind = BeamReadingKind::kRecorded;  // the hypothesis
  double time_increment_s = 0;                        // as Rig::Laser::time_increment_s
  std::optional<double> residual_m;  // robust deviation of distances; absent where surfaces do not match
  std::optional<double> offset_s;    // present where the reading fits
  bool chosen = false;               // the recording was read so
};

/// The stamps of one stream, the laser's or the motor's.
struct StreamStamps {
  StampSource used = StampSource::kHeader;  // the stamps that the recording's times are
  double median_period_s = 0;               // between neighbouring messages
  /// Receive minus header stamps, if both were recorded: the median, and a robust standard deviation about
  /// it.
  std::optional<double> receive_minus_header_s, receive_jitter_s;
};

/// What speaks against the motor's samples as a whole.
struct MotorFaults {
  double range_rad = 0;        // of the angles as recorded, before whole turns are taken out
  double median_step_rad = 0;  // between neighbouring samples, as recorded
  double returned_rad = 0;     // the longest way back, against the direction of the whole turn
  std::string sources;         // two sources whose motions differ, named; else empty
};

/// Irregularities that were found while reading, and how they were handled. A gap is a spacing of more
/// than 1.5 (scans) or 3 (motor samples) times the median one.
struct ReadReport {
  std::vector<RecordedTopic> topics;        // all that the file has
  StreamStamps laser_stamps, motor_stamps;  // which stamps are used
  /// Ranges without a usable return, by what they are.
  std::size_t nan_ranges = 0, infinite_ranges = 0, zero_ranges = 0, out_of_range_ranges = 0;
  /// Scans that were sorted, left out as duplicates, followed by a gap, and left out for another reason.
  std::size_t scans_out_of_order = 0, scans_duplicate = 0, scan_gaps = 0, scans_dropped = 0;
  /// The same of the motor's samples.
  std::size_t motor_out_of_order = 0, motor_duplicate = 0, motor_gaps = 0;
  std::size_t motor_dropped = 0;        // samples without a stamp or a finite angle
  std::size_t motor_repeated = 0;       // samples that repeat an old angle while the motor moves, left out
  std::size_t motor_of_others = 0;      // samples of other publishers of the joint, left out
  std::size_t motor_unwrapped = 0;      // jumps of a whole turn that were taken out
  MotorFaults motor_faults;             // of the samples as a whole
  std::size_t scans_without_motor = 0;  // scans that the motor track does not cover at offset 0
  double longest_scan_gap_s = 0, longest_motor_gap_s = 0;  // 0: no gap
  /// The possible error of the time of a scan's last beam, if a time_increment is a guess or ambiguous
  /// (beam_times.hpp): the mean over the scans.
  double beam_time_doubt_s = 0;
  /// Of an offset at the first scan, what the uncertainty of a profile's speed leaves, where it was found.
  double profile_speed_sigma_s = 0;
  std::vector<BeamReading> readings;  // of the laser's messages, those that were tried; empty: none was
  bool fired_backwards = false;       // scans have the order of time, messages the opposite one
  bool intensities = false;           // every scan has them, whether they were kept or not
  std::vector<std::string> warnings;  // whole sentences for a person
};

/// An actuated scanner's recording: scans ascending in time, ranges in one flat array, NaN for a beam without
/// a usable return, and the motor's track. Offsets are defined by t_motor = t_laser + offset.
struct Recording {
  std::string name;                // of the file without its folder, or of the simulated scene
  std::int64_t epoch_ns = 0;       // origin of all times, ns since 1970 (or of the source's own clock)
  Rig rig;                         // as read and completed by what was detected
  double begins_s = 0;             // of a part: when it begins, since the first scan of the whole
  std::vector<LaserScan> scans;    // ascending in time
  std::vector<float> ranges_m;     // of all scans, one after the other
  std::vector<float> intensities;  // like ranges_m, or empty
  /// For 3D scanners, the beams' unit directions in the laser's frame, like ranges_m; otherwise empty.
  std::vector<Eigen::Vector3f> directions;
  MotorTrack motor;  // angles in rad, on the motor's clock
  /// From the topics that the rig names, otherwise empty; their clocks may be shifted against the laser's.
  TurnRates turn_rates;
  std::vector<StampedPose> odometry;  // of the base frame, likewise
  ReadReport report;                  // irregularities, and how they were handled

  /// The ranges of a scan in m, one for each beam; NaN: no usable return.
  std::span<const float> ranges(const LaserScan& scan) const {
    return {ranges_m.data() + scan.first_range, scan.beams};
  }
  /// The direction of a beam in the laser's frame: unit length.
  Eigen::Vector3d direction(const LaserScan& scan, std::uint32_t beam) const {
    if (!directions.empty()) return directions[scan.first_range + beam].cast<double>();
    const double angle_rad = scan.beam_angle_rad(beam);
    return {std::cos(angle_rad), std::sin(angle_rad), 0.0};
  }
};

/// The scans with first beams in [from_s, to_s] after the first scan's, and the motor's samples from
/// `motor_margin_s` before to as much after them.
Recording window(const Recording& recording, double from_s, double to_s, double motor_margin_s = 1);

/// A part of a recording, in seconds since its first scan.
struct RecordingPart {
  double begin_s = 0, end_s = 0;  // begin <= end
};

/// The window whose times are those of the whole recording that this one may be a part of.
Recording part_of_whole(const Recording& recording, const RecordingPart& part);

/// The scans of several parts, and the recording's first and last scan, so that it lasts as long. The motor's
/// samples are all kept.
Recording parts_of(const Recording& recording, const std::vector<RecordingPart>& parts);

}  // namespace sweepscope
