#include "render/clip.hpp"

#include <algorithm>

namespace sweepscope {

std::optional<std::pair<PixelPoint, PixelPoint>> clip(PixelPoint from, PixelPoint to, const PixelRect& rect) {
  const double step_x = to.x - from.x, step_y = to.y - from.y;
  double enters = 0, leaves = 1;  // parts of the stretch
  const auto narrow = [&](double start, double step, double least, double most) {
    if (step == 0) return start >= least && start <= most;
    const double t1 = (least - start) / step, t2 = (most - start) / step;
    enters = std::max(enters, std::min(t1, t2));
    leaves = std::min(leaves, std::max(t1, t2));
    return enters <= leaves;
  };
  if (!narrow(from.x, step_x, rect.left, rect.right()) || !narrow(from.y, step_y, rect.top, rect.bottom()))
    return std::nullopt;
  const auto at = [&](double t) { return PixelPoint{from.x + t * step_x, from.y + t * step_y}; };
  return std::pair{enters > 0 ? at(enters) : from, leaves < 1 ? at(leaves) : to};
}

}  // namespace sweepscope
