#pragma once

#include "render/picture.hpp"

class vtkRenderWindow;

namespace sweepscope {

/// The size at which VTK draws the picture: larger, for smooth edges.
int drawn_width_px(const Picture& picture);
int drawn_height_px(const Picture& picture);

/// Draws the picture in a window of that size, whatever is behind it. The window has no renderers before and
/// after. Fails with ExitCode::kWrongUsage and VTK's words where VTK cannot draw it.
Result<Image> draw_in(vtkRenderWindow& window, const Picture& picture);

}  // namespace sweepscope
