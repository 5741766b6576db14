#pragma once

#include <vtkSmartPointer.h>

#include <memory>

#include "render/drawing/drawing.hpp"

class vtkContextActor;

namespace sweepscope {

/// An actor that draws over the whole window, with `scale` window pixels for each pixel of the drawing.
vtkSmartPointer<vtkContextActor> make_drawing_actor(std::shared_ptr<const Drawing> drawing, double scale);

}  // namespace sweepscope
