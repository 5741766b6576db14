#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "core/apply/added_topics.hpp"
#include "core/apply/apply.hpp"
#include "core/apply/provenance.hpp"
#include "core/error.hpp"
#include "core/job.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

struct WrittenSweeps {
  std::size_t sweeps = 0;
  bool moving = false;
  std::vector<std::string> warnings;
};

/// Writes each sweep as a cloud (see SweepCloud) into a new folder: 000000.pcd, 000001.pcd ... (or .ply, by
/// `extension`), with the times of the points as the laser's stamps count, and poses.tum, the pose of each
/// cloud's base frame in the map frame at its first beam. The folder appears complete or not at all.
Result<WrittenSweeps> write_sweeps(Recording recording, const AppliedOffset& offset,
                                   const AddOptions& options, const std::filesystem::path& folder,
                                   const std::string& extension, const Job& job);

/// The same for a recording's file, with the options of apply_offset. Where an offset was applied before it
/// is refused as there; tables hold no record of that, they are as they were recorded.
Result<WrittenSweeps> write_applied_sweeps(const std::filesystem::path& recording,
                                           const ApplyOptions& options, const std::filesystem::path& folder,
                                           const std::string& extension, const Job& job);

}  // namespace sweepscope
