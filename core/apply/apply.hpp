#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/apply/provenance.hpp"
#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

struct ApplyOptions {
  AppliedOffset offset;
  std::string estimate;  // the name of the file that it comes from, for the record; or empty
  ShiftedStream shifted = ShiftedStream::kMotor;
  Rig rig;
  std::optional<StampSource> stamps;  // for both streams, whatever the rig says
  bool again = false;                 // also to a recording that it was applied to
};

struct Applied {
  Provenance provenance;
  std::uint64_t moved = 0;  // messages whose stamps were moved
  std::vector<std::string> warnings;
};

/// Writes a recording with one stream's stamps moved onto the other's clock: by header those in the messages'
/// headers, by receive the times at which they were received. All other bytes of all messages, their order,
/// and the descriptions of their topics stay as they are; the index is made anew. A second time is refused
/// (ExitCode::kWrongUsage), since the offset is gone.
///
/// The output's name says its format: .bag, .mcap, .db3; without an extension a folder of a ROS 2 bag with
/// metadata.yaml and a file for each of the input's. Formats of ROS 1 and ROS 2 are not made of each other,
/// but for ROS 1 messages in an MCAP file. Compression stays where the output's format has it.
///
/// The output appears whole or not at all. Takes memory for a chunk and the index, whatever the recording's
/// size.
Result<Applied> apply_offset(const std::filesystem::path& recording, const std::filesystem::path& output,
                             const ApplyOptions& options, const Job& job);

}  // namespace sweepscope
