#pragma once

#include "render/images/eye_dome.hpp"
#include "render/images/image.hpp"

class vtkOpenGLRenderWindow;

namespace sweepscope::gl {

/// What a VTK window drew last, with its rows from the bottom. The images' memory is used again if their size
/// is the window's.
Image read_colours(vtkOpenGLRenderWindow& window, Image into = {});
DepthImage read_depths(vtkOpenGLRenderWindow& window, DepthImage into = {});

}  // namespace sweepscope::gl
