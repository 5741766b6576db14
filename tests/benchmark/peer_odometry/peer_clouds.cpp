#include "peer_clouds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sweepscope/core/geometry/kinematics.hpp"
#include "sweepscope/core/io/cloud_file.hpp"
#include "sweepscope/core/offset/prepared/prepared.hpp"
#include "sweepscope/core/recording/sweeps.hpp"

namespace sweepscope {
namespace {

namespace fs = std::filesystem;

/// Its points are in the order of time; those of a scan follow each other within a millisecond.
PeerCloud from_file(const fs::path& path) {
  constexpr double kNextScan_s = 0.001;
  const auto cloud = read_cloud(path);
  if (!cloud || (*cloud)->empty()) throw std::runtime_error(path.string() + " holds no cloud");
  const auto& points = (*cloud)->points;
  PeerCloud peer{points.front().time_s, points.back().time_s, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0 || points[i].time_s - points[i - 1].time_s > kNextScan_s) peer.lines.emplace_back();
    peer.lines.back().push_back({points[i].getVector3fMap().cast<double>(),
                                 (points[i].time_s - peer.begin_s) / (peer.end_s - peer.begin_s)});
  }
  return peer;
}

/// A line of each sweep that the scan's beams fall in.
void add_scan(const Recording& recording, const LaserScan& scan, double offset_s,
              const Kinematics& kinematics, MotorReader& motor, std::vector<PeerCloud>& clouds) {
  const auto ranges_m = recording.ranges(scan);
  PeerCloud* last = nullptr;
  for (std::uint32_t beam = 0; beam < scan.beams; ++beam) {
    if (!std::isfinite(ranges_m[beam])) continue;
    const double time_s = scan.beam_s(beam);
    const auto cloud =
        std::upper_bound(clouds.begin(), clouds.end(), time_s,
                         [](double t_s, const PeerCloud& candidate) { return t_s < candidate.end_s; });
    if (cloud == clouds.end() || time_s < cloud->begin_s) continue;
    if (&*cloud != last) cloud->lines.emplace_back();
    last = &*cloud;
    const Eigen::Vector3d p_in_motor_m =
        kinematics.point_in_motor(ranges_m[beam], recording.direction(scan, beam));
    cloud->lines.back().push_back(
        {kinematics.base_from_motor(p_in_motor_m, motor.angle_at(time_s + offset_s)),
         (time_s - cloud->begin_s) / (cloud->end_s - cloud->begin_s)});
  }
}

}  // namespace

std::vector<PeerCloud> peer_clouds(const Recording& recording, double offset_s) {
  constexpr double kWhole = 0.8;  // of the middle duration
  const MotorMotion motion = find_sweeps(recording.motor);
  std::vector<PeerCloud> clouds;
  for (const Sweep& sweep : motion.sweeps)
    if (sweep.end_s - sweep.begin_s > kWhole * motion.median_sweep_s)
      clouds.push_back({sweep.begin_s - offset_s, sweep.end_s - offset_s, {}});
  const std::vector<char> covered = scans_covered(recording, offset_s, offset_s);
  const Kinematics kinematics(recording.rig.mount);
  MotorReader motor(recording.motor);
  for (std::size_t i = 0; i < recording.scans.size(); ++i)
    if (covered[i]) add_scan(recording, recording.scans[i], offset_s, kinematics, motor, clouds);
  // The motor may turn before the first scan and after the last one.
  std::erase_if(clouds, [&](const PeerCloud& cloud) {
    return cloud.lines.empty() || cloud.lines.front().front().u > 1 - kWhole ||
           cloud.lines.back().back().u < kWhole;
  });
  return clouds;
}

std::vector<PeerCloud> peer_clouds(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".pcd") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<PeerCloud> clouds;
  for (const fs::path& file : files) clouds.push_back(from_file(file));
  return clouds;
}

}  // namespace sweepscope
