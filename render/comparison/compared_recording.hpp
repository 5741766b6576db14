#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/estimate_options.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "render/comparison/compared_map.hpp"

namespace sweepscope {

/// Maps of one recording, to compare.
struct ComparedRecording {
  std::vector<ComparedMap> maps;
  bool moving = false;
  std::shared_ptr<const SolvedWalk> walk;  // of a moving rig whose trajectory was solved for
  std::string warning;                     // see OffsetMap
};

/// The maps at two to four offsets; another number is ExitCode::kWrongUsage, and for other errors see
/// build_maps. `by_features`: the kind of each point's feature is found as well.
Result<ComparedRecording> compared_recording(const PreparedRecording& prepared,
                                             std::span<const double> offsets_s, const MapOptions& options,
                                             bool by_features, const Job& job);

/// Two to four: another number of offsets is ExitCode::kWrongUsage.
Result<void> check_offset_count(std::size_t offsets);

/// What is drawn below the maps: the paper's criteria of that kind of recording, whatever method an estimate
/// would take, in steps of 1 ms from 5 ms below the offsets to 5 ms above them.
EstimateOptions criteria_about(const ComparedRecording& compared, std::span<const double> offsets_ms);

}  // namespace sweepscope
