#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Chooses which of its two stamps a stream uses: the requested one, or the other one, with a warning, if no
/// message has it. Also warns if the two kinds of stamps run at different speeds, for example because of a
/// wrong unit.
StreamStamps choose_stamps(std::span<const MessageStamps> stamps, StampSource wanted,
                           const std::string& topic, std::vector<std::string>& warnings);

/// Corrects the receive times of messages that a stalled link delivered late, often several at once: a delay
/// (receive minus header stamp) that exceeds the median delay of the messages around it by more than 10 ms
/// and 8 times their robust deviation becomes that median. Messages without one of the stamps keep theirs,
/// and all do if the two clocks run at different speeds.
struct LateMessages {
  std::size_t count = 0;
  double latest_s = 0;  // the largest excess
};
LateMessages correct_late(std::span<MessageStamps> stamps);

/// The stamp of that source in ns; 0 if the message has none.
std::int64_t stamp_ns(const MessageStamps& stamps, StampSource source);

/// An order in which times are strictly ascending: of equal times the first is kept.
struct TimeOrder {
  std::vector<std::size_t> kept;
  std::size_t out_of_order = 0;  // times earlier than one before them
  std::size_t duplicates = 0;
};
TimeOrder order_by_time(std::span<const double> times_s);

/// What one clock stamped of a stream. If a clock was set back, the stamps before and after overlap: messages
/// are twice as dense there, and if the values of a motor are given, they go to and fro between two motions.
struct ClockPart {
  double from_s = 0, to_s = 0;  // the longer side, without the overlap
  double set_back_s = 0;        // about
};
/// Absent if there is no such overlap within the stream. Times in any order.
std::optional<ClockPart> part_of_one_clock(std::span<const double> times_s,
                                           std::span<const double> values = {});
/// A sentence; `start_s`: when the recording starts.
std::string set_back_warning(const ClockPart& part, double start_s, const std::string& topic);

/// How uneven periodic times are: the deviation of their spacings from whole periods, nine times in ten; at
/// most half a period. 0 for fewer than three times.
double unevenness_s(std::span<const double> times_s);

/// The spacing of times that ascend, and the spacings longer than `factor` times the median one.
struct Spacing {
  double median_s = 0;
  std::size_t gaps = 0;
  double longest_gap_s = 0;  // 0 where there is no gap
};
Spacing spacing(std::span<const double> times_s, double factor);

}  // namespace sweepscope
