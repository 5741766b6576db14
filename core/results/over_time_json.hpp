#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "core/offset/over_time/over_time.hpp"

namespace sweepscope {

/// The windows of an offset over time ("over_time") and its course ("middle_s", "rate_ppm", "jumps", ...) as
/// members of an estimate's document.
void write_over_time(const OffsetOverTime& over_time, nlohmann::ordered_json& document);
/// Reads them; absent where the document has none. Throws json::BadValue.
std::optional<OffsetOverTime> over_time_from_json(const nlohmann::ordered_json& document);

}  // namespace sweepscope
