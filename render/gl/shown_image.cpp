#include "render/gl/shown_image.hpp"

#include <vtk_glew.h>

namespace sweepscope::gl {

ShownImage::~ShownImage() {
  if (texture_ == 0) return;
  context_.make_current();
  glDeleteTextures(1, &texture_);
}

void ShownImage::show(const Image& image) {
  context_.make_current();
  if (texture_ == 0) glGenTextures(1, &texture_);
  width_px_ = image.width_px;
  height_px_ = image.height_px;
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width_px_, height_px_, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               image.rgba.data());
  glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace sweepscope::gl
