#pragma once

#include <cairo.h>

#include <memory>
#include <vector>

#include "core/error.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;

/// A view of a scene as an image, and its position in the picture.
struct ViewImage {
  PixelRect place;
  Surface image;
};

/// The picture's views without its marks, at twice its size if possible, so that they stay sharp on paper. A
/// size that draw refuses is ExitCode::kWrongUsage here too, with views or without.
Result<std::vector<ViewImage>> view_images(const Picture& picture);

}  // namespace sweepscope
