#pragma once

#include <cstddef>
#include <span>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/map/offset_map.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/offset/prepared/prepared.hpp"

namespace sweepscope {

/// Two to four maps of a recording are compared: another number of offsets is ExitCode::kWrongUsage.
Result<void> check_offset_count(std::size_t offsets);

/// The criteria that stand beside maps of one recording: the paper's for that kind of rig, whatever method an
/// estimate takes, along the trajectory of the maps, in steps of 1 ms from 2 to 5 ms below their offsets to
/// as much above them. An interruption is ExitCode::kInterrupted.
Result<Estimate> criteria_about(const PreparedRecording& prepared, std::span<const OffsetMap> maps,
                                const KeptCandidates& kept, const Job& job);

}  // namespace sweepscope
