#include "render/page/beam_colours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sweepscope {
namespace {

/// The point of a beam; the cloud's size if it has none.
std::size_t point_of_beam(const MapCloud& cloud, double time_s, const std::array<float, 3>& position_m) {
  const auto of_time = std::ranges::equal_range(cloud.points, time_s, {}, &MapPoint::time_s);
  const Eigen::Vector3f p_m = Eigen::Vector3f::Map(position_m.data());
  const auto distance_m = [&](const MapPoint& point) { return (point.getVector3fMap() - p_m).squaredNorm(); };
  const auto nearest = std::ranges::min_element(of_time, {}, distance_m);
  return nearest == of_time.end() ? cloud.size() : static_cast<std::size_t>(&*nearest - cloud.points.data());
}

}  // namespace

BeamBlur blur_of_beams(const TurnableMap& drawn, std::span<const std::array<float, 3>> positions_m,
                       const ComparedMap& map) {
  BeamBlur blur{map.offset_s.value(), {}};
  blur.thickness_m.assign(drawn.beams.size(), std::numeric_limits<float>::quiet_NaN());
  if (!map.thickness) return blur;
  for (std::size_t i = 0; i < drawn.beams.size(); ++i) {
    if (std::isnan(positions_m[i][0])) continue;
    const std::size_t point = point_of_beam(*map.cloud, drawn.beams[i].time_s, positions_m[i]);
    if (point < map.cloud->size()) blur.thickness_m[i] = map.thickness->surfaces[point].thickness_m;
  }
  return blur;
}

}  // namespace sweepscope
