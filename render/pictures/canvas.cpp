#include "render/pictures/canvas.hpp"

#include <vtk_glew.h>

#include <fmt/format.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkOpenGLFramebufferObject.h>

#include <array>

#include "render/gl/context.hpp"
#include "render/gl/vtk_window.hpp"
#include "render/gl/window.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {
namespace {

constexpr std::array<std::string_view, 3> kBackendNames{"offscreen", "window", "null"};

class OffscreenCanvas final : public Canvas {
 public:
  Result<Image> draw(const Picture& picture) override { return sweepscope::draw(picture); }
};

class WindowCanvas final : public Canvas {
 public:
  explicit WindowCanvas(std::unique_ptr<gl::Window> window) : window_(std::move(window)) {}

  Result<Image> draw(const Picture& picture) override {
    return check_size(picture).and_then([&] {
      auto vtk = gl::make_vtk_window(*window_, drawn_width_px(picture), drawn_height_px(picture));
      auto image = draw_in(*vtk, picture);
      show(*vtk);
      vtk->Finalize();
      return image;
    });
  }

 private:
  /// What was drawn, as large as the window.
  void show(vtkGenericOpenGLRenderWindow& vtk) {
    const int* size = vtk.GetSize();
    vtk.GetDisplayFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
    vtk.GetDisplayFramebuffer()->ActivateReadBuffer(0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, size[0], size[1], 0, 0, window_->width_px(), window_->height_px(),
                      GL_COLOR_BUFFER_BIT, GL_LINEAR);
    window_->present();
    window_->wait(0);
  }

  std::unique_ptr<gl::Window> window_;
};

class NullCanvas final : public Canvas {
 public:
  Result<Image> draw(const Picture& picture) override {
    return check_size(picture).map([&] {
      Image image(picture.width_px, picture.height_px);
      const Colour& colour = picture.background;
      for (std::size_t i = 0; i < image.rgba.size(); i += Image::kChannels) {
        image.rgba[i] = colour.red;
        image.rgba[i + 1] = colour.green;
        image.rgba[i + 2] = colour.blue;
        image.rgba[i + 3] = colour.alpha;
      }
      return image;
    });
  }
};

}  // namespace

Result<Backend> backend(std::string_view name) {
  for (std::size_t i = 0; i < kBackendNames.size(); ++i) {
    if (kBackendNames[i] == name) return static_cast<Backend>(i);
  }
  return failure(ExitCode::kWrongUsage, fmt::format("There is no back end \"{}\"; there are {}", name,
                                                    fmt::join(kBackendNames, ", ")));
}

Result<std::unique_ptr<Canvas>> make_canvas(Backend backend) {
  if (backend == Backend::kOffscreen) {
    return gl::check_offscreen().map(
        [] { return std::unique_ptr<Canvas>(std::make_unique<OffscreenCanvas>()); });
  }
  if (backend == Backend::kNull) return std::make_unique<NullCanvas>();
  constexpr int kWidth_px = 960, kHeight_px = 600;
  auto window = gl::make_window(kWidth_px, kHeight_px, "sweepscope");
  if (!window)
    return failure(window.error().code, window.error().message + ". Without a display: --draw-in offscreen.");
  return std::make_unique<WindowCanvas>(std::move(*window));
}

}  // namespace sweepscope
