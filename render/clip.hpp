#pragma once

#include <optional>
#include <utility>

#include "render/drawing.hpp"

namespace sweepscope {

/// The part of the stretch between two places that lies in a rectangle; none where it misses it. An end that
/// lies inside is kept to the last bit.
std::optional<std::pair<PixelPoint, PixelPoint>> clip(PixelPoint from, PixelPoint to, const PixelRect& rect);

}  // namespace sweepscope
