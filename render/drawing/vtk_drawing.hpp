#pragma once

#include <vtkSmartPointer.h>

#include <memory>

#include "render/drawing/drawing.hpp"

class vtkContextActor;

namespace sweepscope {

/// An actor that paints the drawing over the whole window, `scale` window pixels for each of its pixels.
vtkSmartPointer<vtkContextActor> make_drawing_actor(std::shared_ptr<const Drawing> drawing, double scale);

}  // namespace sweepscope
