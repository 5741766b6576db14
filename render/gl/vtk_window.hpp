#pragma once

#include <vtkSmartPointer.h>

#include <memory>
#include <string>

#include "render/gl/context.hpp"

class vtkGenericOpenGLRenderWindow;

namespace sweepscope::gl {

/// A VTK render window that draws with `context` into a framebuffer of its own and shows nothing by itself.
/// The context must outlive it, and Finalize must be called before the context is destroyed. Several windows
/// may share one.
vtkSmartPointer<vtkGenericOpenGLRenderWindow> make_vtk_window(Context& context, int width_px, int height_px);

/// A window without a screen and its context, destroyed in the right order.
class OffscreenWindow {
 public:
  static Result<OffscreenWindow> create(int width_px, int height_px);

  OffscreenWindow(OffscreenWindow&& other) noexcept;
  OffscreenWindow& operator=(OffscreenWindow&&) = delete;
  ~OffscreenWindow();

  vtkGenericOpenGLRenderWindow& window() { return *window_; }
  const Context& context() const { return *context_; }

 private:
  OffscreenWindow(std::unique_ptr<Context> context, vtkSmartPointer<vtkGenericOpenGLRenderWindow> window);

  std::unique_ptr<Context> context_;
  vtkSmartPointer<vtkGenericOpenGLRenderWindow> window_;
};

/// After the first call VTK no longer writes warnings and errors to stderr.
void quiet_vtk();

/// VTK's first error on this thread since the last call; empty if there was none.
std::string take_vtk_error();

}  // namespace sweepscope::gl
