#pragma once

#include <string>

#include "core/recording/inspect.hpp"

namespace sweepscope {

/// A summary of a recording as a JSON object (schema "sweepscope.info/1"), keys in a fixed order with their
/// units in their names, null where a value is absent, with a line end.
std::string info_to_json(const RecordingSummary& summary);

}  // namespace sweepscope
