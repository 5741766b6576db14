#include "core/recording/raw_recording.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {

double range_of(const RawJoint& joint) {
  double min = HUGE_VAL, max = -HUGE_VAL;
  for (const double position : joint.positions) {
    if (!std::isfinite(position)) continue;
    min = std::min(min, position);
    max = std::max(max, position);
  }
  return max > min ? max - min : 0;
}

std::vector<WrittenMessage> write_order(const RawLaser& laser, const RawJoint& joint) {
  std::vector<WrittenMessage> all;
  all.reserve((laser.of_clouds ? laser.clouds.size() : laser.scans.size()) + joint.stamps.size());
  const auto add = [&](const MessageStamps& stamps, bool is_scan, std::size_t number) {
    all.push_back({stamps.receive_ns != 0 ? stamps.receive_ns : stamps.header_ns, is_scan, number});
  };
  if (laser.of_clouds)
    for (std::size_t i = 0; i < laser.clouds.size(); ++i) add(laser.clouds[i].stamps, true, i);
  else
    for (std::size_t i = 0; i < laser.scans.size(); ++i) add(laser.scans[i].stamps, true, i);
  for (std::size_t i = 0; i < joint.stamps.size(); ++i) add(joint.stamps[i], false, i);
  std::ranges::stable_sort(all, {}, &WrittenMessage::receive_ns);
  return all;
}

}  // namespace sweepscope
