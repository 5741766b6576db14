#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/apply/added_topics.hpp"
#include "core/apply/provenance.hpp"
#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/rig.hpp"

namespace sweepscope {

struct ApplyOptions {
  AppliedOffset offset;
  std::string estimate;  // name of the estimate's file, for the record; or empty
  ShiftedStream shifted = ShiftedStream::kMotor;
  Rig rig;
  std::optional<StampSource> stamps;  // of both streams, overrides the rig
  bool again = false;                 // also if an offset was applied before
  bool far = false;                   // also if the offset is longer than the motor's period
  AddOptions add;                     // topics to add
};

struct Applied {
  Provenance provenance;
  std::uint64_t moved = 0;  // messages whose stamps were moved
  std::vector<std::string> warnings;
};

/// Writes a copy of a recording with the stamps of one stream moved onto the clock of the other: the stamps
/// in the messages' headers, or the receive times. All other bytes of the messages, their order and the
/// descriptions of their topics are unchanged; the index is rebuilt. Applying an offset twice, or one that is
/// longer than the motor's period, is refused (ExitCode::kWrongUsage) unless the options ask for it. What a
/// killed run left beside the output is removed.
///
/// The output's format follows from its name: .bag, .mcap, .db3; without an extension a ROS 2 bag folder with
/// metadata.yaml and one file per input file. Messages are not converted between ROS 1 and ROS 2; an MCAP
/// file holds either. The compression is kept if the output's format has it.
///
/// Topics that are added (AddOptions) are written between the messages of the laser, once all that a message
/// holds was measured; the recording is then read into memory.
///
/// The output appears complete or not at all. Otherwise takes memory for one chunk and the index, independent
/// of the size of the recording.
Result<Applied> apply_offset(const std::filesystem::path& recording, const std::filesystem::path& output,
                             const ApplyOptions& options, const Job& job);

/// Refuses an offset that is longer than the motor's period, which is hardly meant (a wrong unit, or a wrong
/// estimate), unless options.far. Nothing is refused where the motor's period is not known.
Result<void> check_within_period(const Recording& recording, const ApplyOptions& options);

}  // namespace sweepscope
