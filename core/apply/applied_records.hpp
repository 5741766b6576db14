#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/recording/streams/message_stream.hpp"

namespace sweepscope {

/// The provenance records (provenance.hpp) of an MCAP file or a database, in order. None for a ROS 1 bag,
/// where they are messages.
Result<std::vector<std::string>> applied_records(const StreamFile& file);

/// Refuses a recording that an offset was applied to before (ExitCode::kWrongUsage). `has_record_topic`:
/// whether one of its topics is kAppliedTopic.
Result<void> check_not_applied(const StreamRecording& recording, bool has_record_topic);

}  // namespace sweepscope
