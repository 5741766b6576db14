#pragma once

#include <string>

#include "core/error.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// A part of a recording, in seconds since its first scan.
struct TimeWindow {
  double from_s = 0, to_s = 0;

  bool operator==(const TimeWindow&) const = default;
};

/// The part of a recording that lies in the window (see `window`). Fails if no scan lies in it
/// (ExitCode::kWrongUsage); `name` is the recording's, for the message.
Result<Recording> cut_to_window(const Recording& whole, const TimeWindow& part, const std::string& name);

}  // namespace sweepscope
