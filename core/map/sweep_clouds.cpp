#include "core/map/sweep_clouds.hpp"

#include "core/map/beam_placer.hpp"
#include "core/map/pose_reader.hpp"

namespace sweepscope {
namespace {

Pose pose_at(const SweepPose& pose, double time_s) {
  return pose.at((time_s - pose.begin_s) / (pose.end_s - pose.begin_s));
}

SweepPose pose_of(const LaserScan& scan, std::size_t sweep, PoseReader& reader) {
  SweepPose pose;
  pose.sweep = sweep;
  pose.begin_s = scan.first_beam_s;
  pose.end_s = scan.last_beam_s();
  pose.knots = {reader.at(pose.begin_s), reader.at(pose.end_s)};
  return pose;
}

SweepPose in_frame_of(const Pose& map_from_base, SweepPose pose) {
  const Pose base_from_map = map_from_base.inverse();
  for (Pose& knot : pose.knots) knot = base_from_map * knot;
  return pose;
}

}  // namespace

Result<SweepClouds> SweepClouds::create(const PreparedRecording& prepared, double offset_s,
                                        const MapOptions& options, const Job& job) {
  OffsetProblem problem = problem_for(prepared, offset_s, offset_s);
  auto path = find_map_path(problem, offset_s, offset_s, options, job);
  if (!path) return tl::unexpected(path.error());
  SweepClouds clouds(std::move(problem), offset_s, options.poses, std::move(*path));
  clouds.find_sweeps();
  return clouds;
}

void SweepClouds::find_sweeps() {
  const Recording& recording = *problem_.recording;
  if (!path_.moving) stationary_ = stationary_poses(problem_, offset_s_);
  const std::vector<SweepPose>& solved = path_.walk && poses_.empty() ? path_.walk->sweeps : stationary_;
  const std::vector<std::size_t> sweep_of = assign_sweeps(recording.scans, problem_.motor.sweeps, offset_s_);
  const PoseReader given(poses_);
  auto pose = solved.begin();
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    const LaserScan& scan = recording.scans[i];
    if (sweep_of[i] == kNoSweep || !problem_.scan_used[i]) continue;
    while (pose != solved.end() && pose->sweep < sweep_of[i]) ++pose;
    const bool placed = poses_.empty() ? pose != solved.end() && pose->sweep == sweep_of[i]
                                       : given.covers(scan.first_beam_s, scan.last_beam_s());
    if (!placed) continue;
    if (sweeps_.empty() || sweeps_.back().sweep != sweep_of[i])
      sweeps_.push_back({sweep_of[i], {}, poses_.empty() ? &*pose : nullptr});
    sweeps_.back().scans.push_back(std::uint32_t(i));
  }
}

double SweepClouds::begin_s(std::size_t sweep) const {
  return problem_.recording->scans[sweeps_[sweep].scans.front()].first_beam_s;
}

double SweepClouds::end_s(std::size_t sweep) const {
  return problem_.recording->scans[sweeps_[sweep].scans.back()].last_beam_s();
}

SweepCloud SweepClouds::at(std::size_t number) const {
  const ScannedSweep& sweep = sweeps_[number];
  const Recording& recording = *problem_.recording;
  PoseReader given(poses_);
  SweepCloud cloud{begin_s(number), end_s(number), {}, {}};
  cloud.map_from_base = sweep.pose != nullptr ? pose_at(*sweep.pose, cloud.begin_s) : given.at(cloud.begin_s);
  BeamPlacer placer(recording, offset_s_);
  for (const std::uint32_t i : sweep.scans) {
    const LaserScan& scan = recording.scans[i];
    const SweepPose pose = sweep.pose != nullptr ? *sweep.pose : pose_of(scan, sweep.sweep, given);
    placer.place(scan, in_frame_of(cloud.map_from_base, pose), cloud.points);
  }
  cloud.points.width = std::uint32_t(cloud.points.size());
  cloud.points.height = 1;
  cloud.points.is_dense = true;
  return cloud;
}

}  // namespace sweepscope
