#pragma once

#include <string>
#include <vector>

#include "core/apply/message_stream.hpp"
#include "core/error.hpp"

namespace sweepscope {

/// The records (provenance.hpp) that an MCAP file or a database holds beside its messages, in their order;
/// none of a ROS 1 bag, where they are messages.
Result<std::vector<std::string>> applied_records(const StreamFile& file);

}  // namespace sweepscope
