#include "core/map/turnable_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/geometry/kinematics.hpp"
#include "core/geometry/morton.hpp"

namespace sweepscope {
namespace {

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

TurnableMap turnable_map(const Beams& beams, const MapPath& path, std::span<const std::uint32_t> chosen) {
  const Recording& recording = *beams.recording;
  const Kinematics kinematics(recording.rig.mount);
  TurnableMap map;
  map.axis = kinematics.axis();
  map.motor = recording.motor;
  map.sweeps = path.sweeps;
  map.moving = path.walk != nullptr;
  if (path.walk) map.path = path.walk->sweeps;
  std::uint32_t last = ~std::uint32_t{0};
  for (const std::uint32_t i : chosen) {
    const LaserScan& scan = recording.scans[beams.scan[i]];
    if (beams.scan[i] != last) map.scans.push_back({(scan.first_beam_s + scan.last_beam_s()) / 2, 0});
    last = beams.scan[i];
    ++map.scans.back().beams;
    const Eigen::Vector3f p_m =
        kinematics.point_in_motor(beams.range_m(i), recording.direction(scan, beams.beam[i])).cast<float>();
    map.beams.push_back({{p_m.x(), p_m.y(), p_m.z()},
                         beam_intensity(recording, scan, beams.beam[i]),
                         scan.beam_s(beams.beam[i])});
  }
  return map;
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

}  // namespace sweepscope
