#pragma once

#include <vector>

#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// How the messages of a scanner follow each other.
struct MessageTurns {
  double per_message = 1;  // turns of the mirror from one message to the next
  bool backwards = false;  // each ends where the one before began: the last beam of an array was fired first
};

/// The turns of the mirror from one message to the next. Drivers that cover a part of a turn by a message
/// begin each where the one before ended; all others begin in the same direction: 1.
MessageTurns turns_of_messages(const std::vector<RawScan>& messages);

/// Scans that go on where the one before ended, put together and cut again where the mirror passes the first
/// beam's direction: whole turns. `scans` are in order of time and so are their ranges, without gaps.
std::vector<LaserScan> whole_turns(const std::vector<LaserScan>& scans);

}  // namespace sweepscope
