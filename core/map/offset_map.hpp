#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/map_cloud.hpp"
#include "core/geometry/pose.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/prepared/prepared.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

struct MapConsistency;
struct MapPath;

/// How to build a map. The defaults are those of `sweepscope map`.
struct MapOptions {
  std::optional<RigKind> assume;  // instead of the motion test
  /// The trajectory of the base frame, used instead of LOAM's; ascending in time. Poses are interpolated
  /// linearly. Scans before the first and after the last are left out, with a warning; if that is all of
  /// them, nothing is built (ExitCode::kNotIdentifiable). The map is in their frame.
  std::vector<StampedPose> poses;
  /// A moving rig's trajectory if it is already known, such as an estimate's; null: it is solved for.
  std::shared_ptr<const SolvedWalk> walk;
  FeatureOptions features;  // of scans
  MappingOptions mapping;   // of tracking a moving rig
};

/// The map at an offset, with the trajectory of the base frame. The map frame is the base frame at the first
/// sweep's begin.
struct OffsetMap {
  double offset_s = 0;                                // t_motor = t_laser + offset
  MapCloud::Ptr cloud;                                // in m, in the map frame
  std::vector<StampedPose> trajectory;                // two poses a sweep, ascending in time
  std::vector<SweepPose> sweeps;                      // the poses that the beams were placed along
  std::shared_ptr<const SolvedWalk> walk;             // of a moving rig whose trajectory was solved for
  bool moving = false;                                // by the motion test or MapOptions::assume
  bool lost = false;                                  // LOAM lost track: the map is not to be trusted
  std::shared_ptr<const MapConsistency> consistency;  // of the path; see MapPath
  std::string warning;                                // also of the path; else empty
};

/// Builds the map at each of the offsets from the same scans: every beam is placed with the motor angle of
/// its own instant at t_motor = t_laser + offset. A stationary rig has identity poses; a moving one's
/// trajectory is the one that fits best together with the best offset (see SolvedWalk), the same for all
/// maps: one solved for at a wrong offset would hide it. A motor that does not turn back and forth is
/// ExitCode::kNotIdentifiable.
Result<std::vector<OffsetMap>> build_maps(const PreparedRecording& prepared,
                                          std::span<const double> offsets_s, const MapOptions& options,
                                          const Job& job);
/// The same for a recording that is not used for anything else.
Result<std::vector<OffsetMap>> build_maps(const Recording& recording, std::span<const double> offsets_s,
                                          const MapOptions& options, const Job& job);

/// The map along a path that is known already.
OffsetMap map_along(const Recording& recording, const MapPath& path, double offset_s);

/// An upper estimate of the memory that building this number of maps of a recording takes.
std::uint64_t map_memory_bytes(const Recording& recording, std::size_t maps);

}  // namespace sweepscope
