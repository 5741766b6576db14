#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/pose.hpp"
#include "core/job.hpp"
#include "core/map/map_cloud.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/prepared.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

struct MapOptions {
  std::optional<RigKind> assume;  // instead of the motion test
  /// Where the base frame went, instead of LOAM's answer; ascending in time. Between them the pose goes
  /// linearly; scans before the first and after the last are left out, with a warning, and where that is all
  /// of them nothing is built (ExitCode::kNotIdentifiable). The map frame is theirs.
  std::vector<StampedPose> poses;
  /// A moving rig's trajectory where it is known already, such as an estimate's; null: it is solved for.
  std::shared_ptr<const SolvedWalk> walk;
  FeatureOptions features;
  MappingOptions mapping;
};

/// The map at an offset, with where the base frame went. The map frame is the base frame at the first sweep's
/// begin.
struct OffsetMap {
  double offset_s = 0;
  MapCloud::Ptr cloud;
  std::vector<StampedPose> trajectory;     // two poses a sweep, ascending in time
  std::vector<SweepPose> sweeps;           // the poses that the beams were placed along
  std::shared_ptr<const SolvedWalk> walk;  // of a moving rig whose trajectory was solved for
  bool moving = false;
  bool lost = false;    // LOAM lost track: the map is not to be trusted
  std::string warning;  // of poses that do not cover every scan; empty where they do
};

/// Builds the map at each of the offsets from the same scans: every beam is placed with the motor angle of
/// its own instant at t_motor = t_laser + offset. A rig that stood still has identity poses; a moving one's
/// trajectory is the one that fits best together with the best offset (see SolvedWalk), the same for all
/// maps: one solved for at a wrong offset would hide it. A motor that does not turn to and fro is
/// ExitCode::kNotIdentifiable.
Result<std::vector<OffsetMap>> build_maps(const PreparedRecording& prepared,
                                          std::span<const double> offsets_s, const MapOptions& options,
                                          const Job& job);
/// The same of a recording that nothing else is asked of.
Result<std::vector<OffsetMap>> build_maps(const Recording& recording, std::span<const double> offsets_s,
                                          const MapOptions& options, const Job& job);

/// About how much more memory so many maps of a recording that is read take, at the most, to build.
std::uint64_t map_memory_bytes(const Recording& recording, std::size_t maps);

}  // namespace sweepscope
