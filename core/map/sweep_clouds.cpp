#include "core/map/sweep_clouds.hpp"

#include "core/numbers.hpp"

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
  join_remnants();
}

/// A recording hardly ever ends at a reversal: a few scans at an end are no sweep, and join their neighbour.
void SweepClouds::join_remnants() {
  constexpr double kMinPart = 0.2;  // of the median sweep
  const auto scans_of = [](const ScannedSweep& sweep) {
    return static_cast<double>(sweep.scans.end - sweep.scans.first);
  };
  std::vector<double> scans;
  for (const ScannedSweep& sweep : sweeps_) scans.push_back(scans_of(sweep));
  const double min = kMinPart * median(scans);
  const auto is_remnant = [&](const ScannedSweep& sweep) { return scans_of(sweep) < min; };
  if (sweeps_.size() > 2 && is_remnant(sweeps_.back())) {
    sweeps_[sweeps_.size() - 2].scans.end = sweeps_.back().scans.end;
    sweeps_.pop_back();
  }
  if (sweeps_.size() > 2 && is_remnant(sweeps_.front())) {
    sweeps_[1] = {{sweeps_.front().scans.first, sweeps_[1].scans.end}, sweeps_.front().pose};
    sweeps_.erase(sweeps_.begin());
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
