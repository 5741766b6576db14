#pragma once

#include <optional>
#include <string>

#include "core/offset/estimator.hpp"

namespace sweepscope::app {

/// "19:29:1", in milliseconds; an "ms" behind it may stand. Nothing where it is not like that.
std::optional<OffsetRange> parse_range_ms(const std::string& text);
/// "24:0.1:40": initial and accuracy in milliseconds, steps.
std::optional<OffsetsAround> parse_around_ms(const std::string& text);
/// "stationary" or "moving".
std::optional<Method> parse_method(const std::optional<std::string>& text);

}  // namespace sweepscope::app
