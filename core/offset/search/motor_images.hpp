#pragma once

// The mathematics: docs/algorithms.md, section 7.

#include "core/offset/prepared/prepared.hpp"

namespace sweepscope {

/// The right one of the offsets that are whole sweeps from a given one, up to `reach_s` to either side of 0.
/// Their maps are mirror images of each other; but where the motor rests or turns more slowly, scans change
/// less from one to the next. The given one unless another agrees clearly better, and of scanners with rings.
double best_of_images_s(const PreparedRecording& prepared, double given_s, double reach_s);

}  // namespace sweepscope
