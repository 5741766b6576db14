#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

/// Where the offsets of recordings are expected: within a tolerance of a value, both in milliseconds.
struct ExpectedOffset {
  double offset_ms = 0, tolerance_ms = 0;  // tolerance > 0

  /// Whether an offset is at most the tolerance away. Offsets are compared to 1e-9 ms, as they are written.
  bool holds(double found_ms) const;
  /// "24 +- 0.5 ms".
  std::string words() const;
};

/// Reads "24+-0.5", "24 ± 0.5" or "24 +/- 0.5 ms". Anything else is ExitCode::kWrongUsage; the message says
/// what is needed.
Result<ExpectedOffset> parse_expected_offset(std::string_view text);

}  // namespace sweepscope
