#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// When the beams of a scan were fired rests on its time_increment, and drivers get that wrong. Two
/// increments can be right: that of a mirror that turns steadily, period * |angle_increment| / 2 pi, and that
/// of a scan that takes its whole period, period / beams. An increment within 25 % of the mirror's is taken
/// as it is. A driver that leaves out scans makes the period 2 to 10 turns of the mirror: an increment that
/// is so many times shorter is taken as it is where scan_time says the same number of turns. Where scan_time
/// does not, and where the increment is the other one, two readings are possible: the recorded one is used,
/// and what lies between them is the doubt. Any other increment cannot be right and is treated as missing:
/// the rig's is used, else scan_time / beams, in doubt where the mirror's is another one.
enum class IncrementFinding { kSound, kMissing, kSkipsOrTooShort, kWholePeriodOrTooLong, kImpossible };

struct BeamTimes {
  IncrementFinding finding = IncrementFinding::kSound;
  bool of_rig = false;                 // time_increment_s is the rig's
  double time_increment_s = 0;         // what is used; 0 where nothing says it
  double other_s = 0;                  // the other reading; 0 where there is none
  double doubt_s(double beams) const;  // of the last beam's instant: between the two readings
};

/// `period_s` is the scans' own (scan_period_s), 0 where it is not known: increments are not judged then.
BeamTimes judge_beam_times(const RawScan& scan, double period_s, std::optional<double> rig_increment_s);

/// The median spacing of the scans' stamps; 0 of fewer than eight spacings, and of stamps that come unevenly
/// by a quarter of it and more.
double scan_period_s(const std::vector<RawScan>& scans, StampSource stamps);

/// Counts what was found, and says it.
class BeamTimesReport {
 public:
  void add(const RawScan& scan, const BeamTimes& times);
  /// Warnings, whole sentences for a person, about the scans of a topic.
  std::vector<std::string> warnings(const std::string& topic, double period_s) const;
  /// Scans that cannot be used: their beams' times are not known.
  std::string unusable() const;
  /// How far the last beam's instant may be off, in the mean over the scans that are used.
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
