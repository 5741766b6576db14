#include "ui/model/playback.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sweepscope::ui {
namespace {

constexpr double kSameTurn_s = 1e-3;  // the rings of a 3D scanner's turn begin within this time

/// Between the two poses beside the time; at the path's ends those.
std::optional<Eigen::Vector3d> position_at(const std::vector<StampedPose>& path, double time_s) {
  if (path.empty()) return std::nullopt;
  const auto next = std::ranges::lower_bound(path, time_s, {}, &StampedPose::time_s);
  if (next == path.begin()) return path.front().position_m;
  if (next == path.end()) return path.back().position_m;
  const StampedPose& before = *std::prev(next);
  const double part = (time_s - before.time_s) / std::max(next->time_s - before.time_s, 1e-9);
  return Eigen::Vector3d((1 - part) * before.position_m + part * next->position_m);
}

}  // namespace

PlayedScan played_scan(const Placement& placement, double time_s) {
  const auto& scans = placement.loaded->recording.scans;
  const Beams& beams = placement.loaded->beams;
  PlayedScan played;
  if (scans.empty()) return played;
  const double at_s = scans.front().first_beam_s + time_s;
  const auto after = std::ranges::upper_bound(scans, at_s, {}, &LaserScan::first_beam_s);
  const auto last = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - scans.begin() - 1, 0));
  std::size_t first = last;
  while (first > 0 && scans[first - 1].first_beam_s > scans[last].first_beam_s - kSameTurn_s) --first;
  played.scan = last;
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = beams.first_point[first]; i < beams.first_point[last + 1]; ++i)
    chosen.push_back(static_cast<std::uint32_t>(i));
  played.points_m = place_beams(beams, placement.map->path, placement.offset_s, chosen);
  std::erase_if(played.points_m, [](const auto& p_m) { return !std::isfinite(p_m[0]); });
  played.sensor_m = position_at(placement.map->trajectory, at_s);
  return played;
}

double scanner_time_s(const Recording& recording, const Settings& settings) {
  const double first_s = recording.scans.front().first_beam_s;
  if (settings.time_s >= 0) return first_s + settings.time_s;
  if (settings.time_to_s > settings.time_from_s) return first_s + settings.time_to_s;
  return std::numeric_limits<double>::infinity();
}

}  // namespace sweepscope::ui
