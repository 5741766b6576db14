#pragma once

#include <optional>

#include "render/drawing/style.hpp"
#include "render/pictures/depth_cues.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// What a view of a map needs to show depth.
struct DepthLook {
  DepthCues cues;
  Box box;  // of the points: the grid lies below it
  std::optional<ScannerPose> scanner;
  double scale = 1;  // of lines and letters
};

/// The view with the cues that suit its camera.
View with_depth(View view, const DepthLook& look, const Style& style);

}  // namespace sweepscope
