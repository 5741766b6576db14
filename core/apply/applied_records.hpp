#pragma once

#include <string>
#include <vector>

#include "core/apply/message_stream.hpp"
#include "core/error.hpp"

namespace sweepscope {

/// The provenance records (provenance.hpp) of an MCAP file or a database, in order. None for a ROS 1 bag,
/// where they are messages.
Result<std::vector<std::string>> applied_records(const StreamFile& file);

}  // namespace sweepscope
