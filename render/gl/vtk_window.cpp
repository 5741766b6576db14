#include "render/gl/vtk_window.hpp"

#include <vtk_glew.h>

#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <algorithm>
#include <utility>

namespace sweepscope::gl {
namespace {

/// VTK's window on a context that it did not make. VTK's own would ask for an X server.
class ContextWindow final : public vtkGenericOpenGLRenderWindow {
 public:
  static ContextWindow* New();
  // NOLINTNEXTLINE(bugprone-derived-method-shadowing-base-method): as every class of VTK
  vtkTypeMacro(ContextWindow, vtkGenericOpenGLRenderWindow)

      void adopt(Context& context) {
    context_ = &context;
    SetIsDirect(1);
    SetSupportsOpenGL(1);
    SetReadyForRendering(true);
    SetFrameBlitModeToNoBlit();
    SetMultiSamples(0);
    SetDPI(72);
  }

  void MakeCurrent() override { context_->make_current(); }
  bool IsCurrent() override { return context_->is_current(); }

  void OpenGLInitContext() override {
    if (Initialized) return;
    constexpr GLenum kNoGlxDisplay = 4;  // GLEW has loaded everything by then and only misses GLX
    const GLenum loaded = glewInit();
    GlewInitValid = (loaded == GLEW_OK || loaded == kNoGlxDisplay) && GLEW_VERSION_3_2;
    if (!GlewInitValid) return;
    Initialized = true;
    MaximumHardwareLineWidth = 1;
  }

 private:
  Context* context_ = nullptr;
};

vtkStandardNewMacro(ContextWindow);

thread_local std::string first_error;

/// Of "ERROR: In FILE, line N\nvtkThing (0x55...): what is wrong\n\n" what is wrong: the rest differs from
/// run to run.
std::string without_place(std::string text) {
  if (const std::size_t at = text.find("): "); at != std::string::npos) text.erase(0, at + 3);
  text.erase(std::min(text.find('\n'), text.size()));
  return text;
}

/// What VTK would show its messages in.
class Messages final : public vtkOutputWindow {
 public:
  static Messages* New();
  // NOLINTNEXTLINE(bugprone-derived-method-shadowing-base-method): as every class of VTK
  vtkTypeMacro(Messages, vtkOutputWindow)

      void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error.empty()) first_error = without_place(text);
  }
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}
};

vtkStandardNewMacro(Messages);

bool begin() {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkOutputWindow::SetInstance(vtkSmartPointer<Messages>::New());
  return true;
}

}  // namespace

vtkSmartPointer<vtkGenericOpenGLRenderWindow> make_vtk_window(Context& context, int width_px, int height_px) {
  quiet_vtk();
  context.make_current();
  auto window = vtkSmartPointer<ContextWindow>::New();
  window->adopt(context);
  window->SetSize(width_px, height_px);
  return window;
}

Result<OffscreenWindow> OffscreenWindow::create(int width_px, int height_px) {
  // VTK draws into its own framebuffer: the context's stays as small as it can be.
  return make_offscreen_context(16, 16).map([&](std::unique_ptr<Context>&& context) {
    auto window = make_vtk_window(*context, width_px, height_px);
    return OffscreenWindow(std::move(context), std::move(window));
  });
}

OffscreenWindow::OffscreenWindow(std::unique_ptr<Context> context,
                                 vtkSmartPointer<vtkGenericOpenGLRenderWindow> window)
    : context_(std::move(context)), window_(std::move(window)) {}

OffscreenWindow::OffscreenWindow(OffscreenWindow&& other) noexcept = default;

OffscreenWindow::~OffscreenWindow() {
  if (!window_) return;
  context_->make_current();
  window_->Finalize();
  window_ = nullptr;
}

void quiet_vtk() {
  static const bool begun = begin();
  (void)begun;
}

std::string take_vtk_error() {
  return std::exchange(first_error, "");
}

}  // namespace sweepscope::gl
