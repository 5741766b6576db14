#include "core/map/turnable_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/geometry/kinematics.hpp"
#include "core/geometry/morton.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMaxBeams = 4'000'000;

std::size_t usable_beams(const Recording& recording, std::span<const char> used) {
  std::size_t beams = 0;
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    if (!used[i]) continue;
    const auto ranges_m = recording.ranges(recording.scans[i]);
    beams += static_cast<std::size_t>(
        std::ranges::count_if(ranges_m, [](float range_m) { return std::isfinite(range_m); }));
  }
  return beams;
}

// Keeps every n-th of all the beams that it is given.
class BeamCollector {
 public:
  BeamCollector(const Recording& recording, std::size_t stride, std::vector<TurnableBeam>& beams)
      : recording_(recording), kinematics_(recording.rig.mount), stride_(stride), beams_(beams) {}

  void add(const LaserScan& scan) {
    const auto ranges_m = recording_.ranges(scan);
    for (std::uint32_t beam = 0; beam < scan.beams; ++beam) {
      if (!std::isfinite(ranges_m[beam]) || seen_++ % stride_ != 0) continue;
      const Eigen::Vector3f p_m =
          kinematics_.point_in_motor(ranges_m[beam], recording_.direction(scan, beam)).cast<float>();
      const float intensity =
          recording_.intensities.empty() ? 0.0F : recording_.intensities[scan.first_range + beam];
      beams_.push_back({{p_m.x(), p_m.y(), p_m.z()}, intensity, scan.beam_s(beam)});
    }
  }

 private:
  const Recording& recording_;
  Kinematics kinematics_;
  std::size_t stride_, seen_ = 0;
  std::vector<TurnableBeam>& beams_;
};

// The sweep of each scan as assign_sweeps() finds it, which needs no more of a scan than its middle.
std::vector<std::size_t> sweep_of_scans(const TurnableMap& map, double offset_s) {
  std::vector<LaserScan> middles(map.scans.size());
  for (std::size_t i = 0; i < middles.size(); ++i) {
    middles[i].first_beam_s = map.scans[i].middle_s;
    middles[i].beams = 1;
  }
  return assign_sweeps(middles, map.sweeps, offset_s);
}

const SweepPose* pose_of(const TurnableMap& map, std::size_t sweep) {
  const auto found = std::ranges::lower_bound(map.path, sweep, {}, &SweepPose::sweep);
  return found != map.path.end() && found->sweep == sweep ? &*found : nullptr;
}

// The coarsest cubes, of 2^level mm, of which a point is the first on the curve; -1 where it shares even the
// finest with the one before it.
int first_of_level(const std::vector<MortonKey>& keys, std::size_t k) {
  if (k == 0) return kMortonBits;
  const std::uint64_t difference = keys[k].code ^ keys[k - 1].code;
  return difference == 0 ? -1 : (static_cast<int>(std::bit_width(difference)) - 1) / 3;
}

std::vector<MortonKey> along_curve(std::span<const std::array<float, 3>> points_m) {
  constexpr double kFinest_m = 1e-3;
  std::vector<std::uint32_t> finite;
  std::array<float, 3> corner_m;
  corner_m.fill(std::numeric_limits<float>::max());
  for (std::uint32_t i = 0; i < points_m.size(); ++i) {
    if (std::isnan(points_m[i][0])) continue;
    finite.push_back(i);
    for (std::size_t axis = 0; axis < 3; ++axis) corner_m[axis] = std::min(corner_m[axis], points_m[i][axis]);
  }
  return along_morton_curve(points_m, finite, corner_m, kFinest_m);
}

}  // namespace

TurnableMap turnable_map(const PreparedRecording& prepared, const std::vector<SweepPose>* path, double from_s,
                         double to_s) {
  const Recording& recording = *prepared.recording;
  const std::vector<char> used = scans_covered(recording, from_s, to_s);
  TurnableMap map;
  map.axis = Kinematics(recording.rig.mount).axis();
  map.motor = recording.motor;
  map.sweeps = prepared.motor.sweeps;
  map.moving = path != nullptr;
  if (path != nullptr) map.path = *path;
  map.usable_beams = usable_beams(recording, used);
  BeamCollector collector(recording, 1 + map.usable_beams / kMaxBeams, map.beams);
  for (std::size_t i = 0; i < recording.scans.size(); ++i) {
    if (!used[i]) continue;
    const LaserScan& scan = recording.scans[i];
    const std::size_t before = map.beams.size();
    collector.add(scan);
    map.scans.push_back({(scan.first_beam_s + scan.last_beam_s()) / 2, map.beams.size() - before});
  }
  return map;
}

std::vector<std::array<float, 3>> positions_at(const TurnableMap& map, double offset_s) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::array<float, 3>> positions_m(map.beams.size(), {kNan, kNan, kNan});
  const std::vector<std::size_t> sweep_of = sweep_of_scans(map, offset_s);
  Mount mount;
  mount.axis = map.axis;
  const Kinematics kinematics(mount);
  MotorReader motor(map.motor);
  std::size_t first = 0;
  for (std::size_t s = 0; s < map.scans.size(); first += map.scans[s++].beams) {
    if (sweep_of[s] == kNoSweep) continue;
    const SweepPose* pose = map.moving ? pose_of(map, sweep_of[s]) : nullptr;
    if (map.moving && pose == nullptr) continue;
    const SweepMotion motion = pose != nullptr ? pose->motion() : SweepPose().motion();
    for (std::size_t i = first; i < first + map.scans[s].beams; ++i) {
      const TurnableBeam& beam = map.beams[i];
      const Eigen::Vector3d p_in_motor_m(beam.p_in_motor_m[0], beam.p_in_motor_m[1], beam.p_in_motor_m[2]);
      Eigen::Vector3d p_m = kinematics.base_from_motor(p_in_motor_m, motor.angle_at(beam.time_s + offset_s));
      if (pose != nullptr) p_m = motion(p_m, (beam.time_s - pose->begin_s) / (pose->end_s - pose->begin_s));
      const Eigen::Vector3f position_m = p_m.cast<float>();
      positions_m[i] = {position_m.x(), position_m.y(), position_m.z()};
    }
  }
  return positions_m;
}

MapCloud cloud_at(const TurnableMap& map, double offset_s) {
  MapCloud cloud;
  const auto positions_m = positions_at(map, offset_s);
  const std::vector<std::size_t> sweep_of = sweep_of_scans(map, offset_s);
  std::size_t first = 0;
  for (std::size_t s = 0; s < map.scans.size(); first += map.scans[s++].beams) {
    for (std::size_t i = first; i < first + map.scans[s].beams; ++i) {
      if (std::isnan(positions_m[i][0])) continue;
      MapPoint point{};
      point.getVector3fMap() = Eigen::Vector3f::Map(positions_m[i].data());
      point.data[3] = 1.0F;
      point.intensity = map.beams[i].intensity;
      point.sweep = static_cast<std::uint32_t>(sweep_of[s]);
      point.time_s = map.beams[i].time_s;
      cloud.push_back(point);
    }
  }
  return cloud;
}

std::vector<std::uint32_t> evenly_in_space(std::span<const std::array<float, 3>> points_m,
                                           std::size_t count) {
  const std::vector<MortonKey> keys = along_curve(points_m);
  std::array<std::size_t, kMortonBits + 2> of_levels{};  // from -1 on
  const auto of_level = [&](int level) -> std::size_t& {
    return of_levels[static_cast<std::size_t>(level) + 1];
  };
  for (std::size_t k = 0; k < keys.size(); ++k) ++of_level(first_of_level(keys, k));
  int whole = kMortonBits;  // all points of this level and above are kept
  std::size_t kept = of_level(whole);
  while (whole > -1 && kept + of_level(whole - 1) <= count) kept += of_level(--whole);
  const std::size_t rest = count > kept ? count - kept : 0;
  std::vector<std::uint32_t> chosen;
  for (std::size_t k = 0, seen = 0; k < keys.size(); ++k) {
    const int level = first_of_level(keys, k);
    bool taken = level >= whole;
    if (level == whole - 1) {
      taken = (seen + 1) * rest / of_level(level) > seen * rest / of_level(level);
      ++seen;
    }
    if (taken && chosen.size() < count) chosen.push_back(keys[k].index);
  }
  std::ranges::sort(chosen);
  return chosen;
}

TurnableMap with_beams(const TurnableMap& map, std::span<const std::uint32_t> kept) {
  TurnableMap part = map;
  part.beams.clear();
  part.scans.clear();
  std::size_t first = 0, next = 0;
  for (const TurnableScan& scan : map.scans) {
    TurnableScan fewer{scan.middle_s, 0};
    for (; next < kept.size() && kept[next] < first + scan.beams; ++next, ++fewer.beams)
      part.beams.push_back(map.beams[kept[next]]);
    if (fewer.beams > 0) part.scans.push_back(fewer);
    first += scan.beams;
  }
  return part;
}

}  // namespace sweepscope
