#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// One of the two streams of a recording, as used.
struct StreamSummary {
  std::string topic;
  std::size_t used = 0;  // scans or motor samples
  StampSource stamp = StampSource::kHeader;
  double median_period_s = 0;
  double duration_s = 0;  // from the first to the last
  std::size_t gaps = 0, out_of_order = 0, duplicates = 0, dropped = 0;
  double longest_gap_s = 0;
  std::optional<double> receive_minus_header_s, receive_jitter_s;

  double rate_hz() const { return median_period_s > 0 ? 1 / median_period_s : 0; }
};

struct LaserSummary : StreamSummary {
  std::size_t min_beams = 0, max_beams = 0;      // of a scan
  std::size_t rings = 0;                         // of a 3D scanner, or slices of its clouds; 0: a 2D scanner
  double first_beam_deg = 0, last_beam_deg = 0;  // of the first scan
  StampAt stamp_at = StampAt::kFirstBeam;
  double uneven_s = 0;  // see unevenness_s() in stream_stamps.hpp
  double scan_s = 0;    // median time from a scan's first to its last beam
  std::size_t beams = 0, usable_beams = 0;
  std::size_t nan = 0, infinite = 0, zero = 0, out_of_range = 0;  // of the whole file
  double median_range_m = 0;
  std::size_t scans_without_motor = 0;  // at offset 0
  double beam_time_doubt_s = 0;         // see ReadReport
  std::vector<BeamReading> readings;    // likewise
  bool intensities = false;
};

struct MotorSummary : StreamSummary {
  std::string joint;
  double min_deg = 0, max_deg = 0;
  double median_speed_deg_s = 0;  // of the sweeps, away from their reversals
  std::size_t reversals = 0;
  std::size_t unwrapped = 0;
  std::size_t repeated = 0;   // samples left out that repeat an old angle while the motor moves
  std::size_t of_others = 0;  // samples left out of other publishers of the joint
  double median_sweep_s = 0;  // 0 where there is no whole sweep
  bool turns = false;         // by more than 1 deg
  bool one_way = false;       // more than a turn, and never back

  std::size_t whole_sweeps() const { return reversals > 0 ? reversals - 1 : 0; }
  /// The turns of a motor that turns one way.
  double turns_one_way() const { return one_way ? (max_deg - min_deg) / 360 : 0; }
  /// The angle by which 1 ms of offset turns a scan.
  double deg_per_ms() const { return median_speed_deg_s / 1000; }
};

/// A summary of a recording, for a person to read.
struct RecordingSummary {
  std::string name;
  std::vector<RecordedTopic> topics;
  LaserSummary laser;
  MotorSummary motor;
  std::optional<std::string> motion;  // "stationary" or "moving", where the motion test was run
  /// Of a moving rig the longest part in which it was stationary; seconds since the first scan.
  std::optional<RecordingPart> stationary_part;
  std::vector<std::string> expectations;  // whole sentences; see expectations() in core/offset
  std::vector<std::string> warnings;
};

/// Counts from reading (gaps, order, kinds of unusable ranges) are those of the whole file, also if
/// `recording` is a window of it.
RecordingSummary inspect(const Recording& recording);

}  // namespace sweepscope
