#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// The times of a scan's beams depend on its time_increment, which some drivers set wrong. Two increments are
/// plausible: that of a mirror that turns steadily, period * |angle_increment| / 2 pi, and that of a scan
/// that takes its whole period, period / beams. An increment within 25 % of the mirror's is used unchanged.
/// If a driver leaves out scans, the period is 2 to 10 turns of the mirror: an increment shorter by that
/// factor is used unchanged if scan_time gives the same number of turns. If scan_time does not, or if the
/// increment is the second one, there are two readings: the recorded one is used, and the difference is the
/// doubt. Any other increment is implausible and is treated as missing: scan_time / beams is used, with doubt
/// if the mirror's differs.
///
/// An increment of the rig file replaces the recorded one unless both are within 25 % of each other and have
/// the same sign.
enum class IncrementFinding { kSound, kMissing, kSkipsOrTooShort, kWholePeriodOrTooLong, kImpossible };

/// Whether a time_increment is given, and shorter than one second.
bool usable_increment(double increment_s);

/// Whether the last beam of the scan's array was fired first: if the rig's or the recorded increment is
/// negative.
bool fired_backwards(const RawScan& scan, std::optional<double> rig_increment_s);

struct BeamTimes {
  IncrementFinding finding = IncrementFinding::kSound;
  bool of_rig = false;                     // time_increment_s is the rig's
  std::optional<double> time_increment_s;  // the value in use, >= 0; absent if unknown
  double other_s = 0;                      // the other reading; 0 where there is none
  double doubt_s(double beams) const;      // of the last beam's instant: between the two readings
};

/// `period_s` is that of a turn of the mirror (scan_period_s, turns_of_messages), or 0 if it is not known:
/// increments are then not checked. The scan's beams and the rig's increment are in the order of time (see
/// fired_backwards). `turns`: that the mirror makes from message to message.
BeamTimes judge_beam_times(const RawScan& scan, double period_s, std::optional<double> rig_increment_s,
                           double turns = 1);

/// The median spacing of the scans' stamps; 0 for fewer than eight spacings, and for stamps that are uneven
/// by at least a quarter of it.
double scan_period_s(const std::vector<RawScan>& scans, StampSource stamps);

/// Counts the findings and words them.
class BeamTimesReport {
 public:
  /// `explained`: where the rig's increment comes from is said elsewhere.
  void add(const RawScan& scan, const BeamTimes& times, bool explained = false);
  /// Warnings, whole sentences for a person, about the scans of a topic.
  std::vector<std::string> warnings(const std::string& topic, double period_s) const;
  /// Scans that cannot be used: their beams' times are not known.
  std::string unusable() const;
  /// The possible error of the last beam's time, mean over the scans in use.
  double doubt_s() const { return used_ > 0 ? doubt_sum_s_ / static_cast<double>(used_) : 0; }

 private:
  struct Seen {
    std::size_t scans = 0;
    RawScan scan;  // the first
    BeamTimes times;
  };
  std::string warning(const Seen& seen, const std::string& topic, double period_s) const;

  Seen missing_, skips_, whole_period_, impossible_, corrected_;
  std::size_t without_any_ = 0, used_ = 0;
  double doubt_sum_s_ = 0;
};

}  // namespace sweepscope
