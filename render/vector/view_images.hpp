#pragma once

#include <cairo.h>

#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, DestroySurface>;

/// For Cairo's streams, whose closure is a std::string.
inline cairo_status_t append_bytes(void* out, const unsigned char* bytes, unsigned int length) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(bytes), length);
  return CAIRO_STATUS_SUCCESS;
}

/// A view of a scene as an image, and its position in the picture.
struct ViewImage {
  PixelRect place;
  Surface image;
};

/// The picture's views without its marks, at twice its size if possible, so that they stay sharp on paper. A
/// size that draw refuses is ExitCode::kWrongUsage here too, with views or without.
Result<std::vector<ViewImage>> view_images(const Picture& picture);

}  // namespace sweepscope
