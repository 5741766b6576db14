#include "render/gl/default_framebuffer.hpp"

#include <vtk_glew.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace sweepscope::gl {
namespace {

/// GLEW's functions go through the same dispatch whatever the context: loading them once is enough.
void load_functions() {
  static const GLenum loaded = glewInit();
  (void)loaded;
}

}  // namespace

void begin_default_framebuffer(Context& context, Colour colour) {
  context.make_current();
  load_functions();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glViewport(0, 0, context.width_px(), context.height_px());
  glClearColor(static_cast<float>(colour.red) / 255, static_cast<float>(colour.green) / 255,
               static_cast<float>(colour.blue) / 255, 1);
  glClear(GL_COLOR_BUFFER_BIT);  // nothing that is drawn here has a depth
}

std::string renderer_of_current() {
  load_functions();
  const auto* name = glGetString(GL_RENDERER);
  return name != nullptr ? reinterpret_cast<const char*>(name) : "";
}

void finish_drawing(Context& context) {
  context.make_current();
  load_functions();
  glFinish();
}

Image read_default_framebuffer(Context& context) {
  context.make_current();
  load_functions();
  Image image(context.width_px(), context.height_px());
  std::vector<std::uint8_t> rows(image.rgba.size());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width_px, image.height_px, GL_RGBA, GL_UNSIGNED_BYTE, rows.data());
  const std::size_t row_bytes = Image::kChannels * static_cast<std::size_t>(image.width_px);
  for (int y = 0; y < image.height_px; ++y) {  // OpenGL's first row is the lowest
    std::memcpy(image.pixel(0, y),
                rows.data() + row_bytes * static_cast<std::size_t>(image.height_px - 1 - y), row_bytes);
  }
  image.make_opaque();  // a window's alpha is whatever blending left there
  return image;
}

}  // namespace sweepscope::gl
