#include "render/gl/read_framebuffer.hpp"

#include <vtk_glew.h>

#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>

namespace sweepscope::gl {
namespace {

void read(vtkOpenGLRenderWindow& window, int stride_px, GLenum format, GLenum type, void* into) {
  const int* size_px = window.GetSize();
  window.GetState()->PushReadFramebufferBinding();
  vtkOpenGLFramebufferObject& drawn = *window.GetRenderFramebuffer();
  drawn.Bind(vtkOpenGLFramebufferObject::GetReadMode());
  drawn.ActivateReadBuffer(0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_PACK_ROW_LENGTH, stride_px);
  glReadPixels(0, 0, size_px[0], size_px[1], format, type, into);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  window.GetState()->PopReadFramebufferBinding();
}

}  // namespace

Image read_colours(vtkOpenGLRenderWindow& window, Image into) {
  const int* size_px = window.GetSize();
  if (into.width_px != size_px[0] || into.height_px != size_px[1]) into = Image(size_px[0], size_px[1]);
  read(window, into.width_px, GL_RGBA, GL_UNSIGNED_BYTE, into.rgba.data());
  return into;
}

DepthImage read_depths(vtkOpenGLRenderWindow& window, DepthImage into) {
  const int* size_px = window.GetSize();
  if (into.width_px() != size_px[0] || into.height_px() != size_px[1])
    into = DepthImage(size_px[0], size_px[1]);
  read(window, into.stride(), GL_DEPTH_COMPONENT, GL_FLOAT, into.row(0));
  return into;
}

}  // namespace sweepscope::gl
