#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/geometry/map_cloud.hpp"
#include "core/job.hpp"
#include "core/map/map_path.hpp"
#include "core/map/place_beams.hpp"
#include "core/map/scan_poses.hpp"
#include "core/offset/prepared/prepared.hpp"

namespace sweepscope {

/// One sweep of the motor as a cloud in the base frame of its first beam: the motion of the motor is removed,
/// and that of the rig too.
struct SweepCloud {
  double begin_s = 0, end_s = 0;  // first and last beam, laser clock, seconds since Recording::epoch_ns
  Pose map_from_base;             // at begin_s
  MapCloud points;
};

/// The sweeps of a recording as clouds; a few scans at either end belong to the neighbouring cloud. Each is
/// made when it is asked for, so that they take no memory. Beams are placed as in a map: see build_maps.
class SweepClouds {
 public:
  /// The recording that was prepared must outlive it. For the errors see build_maps.
  static Result<SweepClouds> create(const PreparedRecording& prepared, double offset_s,
                                    const MapOptions& options, const Job& job);

  SweepClouds(SweepClouds&&) = default;
  SweepClouds& operator=(SweepClouds&&) = delete;

  std::size_t size() const { return sweeps_.size(); }
  /// Seconds since Recording::epoch_ns.
  double begin_s(std::size_t sweep) const;
  double end_s(std::size_t sweep) const;
  SweepCloud at(std::size_t sweep) const;

  bool moving() const { return path_.moving; }
  bool lost() const { return path_.lost(); }
  /// Of poses that do not cover every scan; empty where they do.
  const std::string& warning() const { return path_.warning; }

 private:
  struct ScannedSweep {
    ScanRange scans;         // those that are placed are of this sweep, or of a remnant that joined it
    std::uint32_t pose = 0;  // of the first of them
  };
  SweepClouds(const Recording& recording, MapPath path, double offset_s);
  void join_remnants();

  const Recording* recording_;
  MapPath path_;
  ScanPoses poses_;
  std::vector<ScannedSweep> sweeps_;
};

}  // namespace sweepscope
