#include "core/map/sweep_clouds.hpp"

namespace sweepscope {

Result<SweepClouds> SweepClouds::create(const PreparedRecording& prepared, double offset_s,
                                        const MapOptions& options, const Job& job) {
  auto path = find_map_path(prepared, offset_s, offset_s, options, job);
  if (!path) return tl::unexpected(path.error());
  return SweepClouds(*prepared.recording, std::move(*path), offset_s);
}

SweepClouds::SweepClouds(const Recording& recording, MapPath path, double offset_s)
    : recording_(&recording), path_(std::move(path)), poses_(recording, path_, offset_s) {
  std::size_t sweep = kNoSweep;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const std::uint32_t pose = poses_.pose_of(i);
    if (pose == ScanPoses::kNone) continue;
    if (poses_.poses()[pose].sweep != sweep) sweeps_.push_back({{i, i}, pose});
    sweeps_.back().scans.end = i + 1;
    sweep = poses_.poses()[pose].sweep;
  }
}

double SweepClouds::begin_s(std::size_t sweep) const {
  return recording_->scans[sweeps_[sweep].scans.first].first_beam_s;
}

double SweepClouds::end_s(std::size_t sweep) const {
  return recording_->scans[sweeps_[sweep].scans.end - 1].last_beam_s();
}

SweepCloud SweepClouds::at(std::size_t number) const {
  const ScannedSweep& sweep = sweeps_[number];
  const SweepPose& pose = poses_.poses()[sweep.pose];
  SweepCloud cloud{begin_s(number), end_s(number), {}, {}};
  cloud.map_from_base = pose.at((cloud.begin_s - pose.begin_s) / (pose.end_s - pose.begin_s));
  cloud.points = place_scans(*recording_, poses_, sweep.scans, cloud.map_from_base.inverse());
  return cloud;
}

}  // namespace sweepscope
