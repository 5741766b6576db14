#include "render/pictures/picture.hpp"

#include <vtk_glew.h>

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkContextActor.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLPolyDataMapper.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstring>

#include "render/clouds/point_polydata.hpp"
#include "render/drawing/vtk_drawing.hpp"
#include "render/gl/vtk_window.hpp"

namespace sweepscope {
namespace {

constexpr int kSupersampling = 2;
constexpr std::size_t kSlicePoints = 65536;

std::vector<std::array<std::uint8_t, 3>> colours_of(const ColouredPoints& points, const ColourScale& scale) {
  std::vector<std::array<std::uint8_t, 3>> rgb;
  rgb.reserve(points.size());
  for (const float value : points.values) {
    const Colour colour = scale.at(static_cast<double>(value));
    rgb.push_back({colour.red, colour.green, colour.blue});
  }
  return rgb;
}

/// Returns when its points are drawn. A software renderer draws for all contexts with the same threads: an
/// interface beside would have to wait for whole clouds.
class PatientMapper final : public vtkOpenGLPolyDataMapper {
 public:
  static PatientMapper* New();
  vtkTypeMacro(PatientMapper,
               vtkOpenGLPolyDataMapper)  // NOLINT(bugprone-derived-method-shadowing-base-method)

      void RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor) override {
    Superclass::RenderPieceFinish(renderer, actor);
    glFinish();
  }
};
vtkStandardNewMacro(PatientMapper);

/// The layer in slices, in its own order.
void add_actors(const CloudLayer& layer, const ColourScale& scale, vtkRenderer& renderer) {
  const auto rgb = colours_of(*layer.points, scale);
  for (std::size_t from = 0; from < rgb.size(); from += kSlicePoints) {
    const std::size_t count = std::min(kSlicePoints, rgb.size() - from);
    vtkNew<PatientMapper> mapper;
    mapper->SetInputData(to_polydata(std::span(layer.points->xyz_m).subspan(from, count),
                                     std::span(rgb).subspan(from, count)));
    mapper->SetColorModeToDirectScalars();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetPointSize(static_cast<float>(layer.point_size_px * kSupersampling));
    renderer.AddActor(actor);
  }
}

void set_background(vtkRenderer& renderer, Colour colour) {
  const double alpha = colour.alpha / 255.0;  // blending leaves colours multiplied by alpha
  renderer.SetBackground(alpha * colour.red / 255.0, alpha * colour.green / 255.0,
                         alpha * colour.blue / 255.0);
  renderer.SetBackgroundAlpha(alpha);
}

void set_camera(vtkRenderer& renderer, const Camera& camera) {
  vtkCamera& out = *renderer.GetActiveCamera();
  out.SetPosition(camera.position_m.data());
  out.SetFocalPoint(camera.looks_at_m.data());
  out.SetViewUp(camera.up.data());
  out.SetParallelProjection(camera.orthographic);
  out.SetParallelScale(camera.view_height_m / 2);
  out.SetViewAngle(camera.view_angle_deg);
  renderer.ResetCameraClippingRange();
}

vtkSmartPointer<vtkRenderer> to_renderer(const View& view, const Picture& picture) {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  const double width = picture.width_px, height = picture.height_px;
  renderer->SetViewport(view.place.left / width, 1 - view.place.bottom() / height, view.place.right() / width,
                        1 - view.place.top / height);
  set_background(*renderer, view.scene.background);
  for (const CloudLayer& layer : view.scene.clouds) {
    if (layer.points) add_actors(layer, view.scene.colours, *renderer);
  }
  set_camera(*renderer, view.scene.camera);
  return renderer;
}

/// The picture's background, which each view then covers with its own; and the marks, in a layer above.
void add_flat_layers(vtkRenderWindow& window, const Picture& picture) {
  vtkNew<vtkRenderer> below;
  set_background(*below, picture.background);
  window.SetNumberOfLayers(2);
  window.AddRenderer(below);
  vtkNew<vtkRenderer> above;
  above->SetLayer(1);
  above->AddActor(make_drawing_actor(std::make_shared<const Drawing>(flat_marks(picture)), kSupersampling));
  window.AddRenderer(above);
}

Image read_pixels(vtkRenderWindow& window, int width_px, int height_px) {
  vtkNew<vtkUnsignedCharArray> pixels;
  window.GetRGBACharPixelData(0, 0, width_px - 1, height_px - 1, 0, pixels);
  Image image(width_px, height_px);
  const std::size_t row_bytes = Image::kChannels * static_cast<std::size_t>(width_px);
  for (int y = 0; y < height_px; ++y) {  // OpenGL's first row is the lowest
    std::memcpy(image.pixel(0, y),
                pixels->GetPointer(static_cast<vtkIdType>(row_bytes) * (height_px - 1 - y)), row_bytes);
  }
  return image;
}

bool is_opaque(const Picture& picture) {
  return picture.background.alpha == 255 &&
         std::all_of(picture.views.begin(), picture.views.end(),
                     [](const View& view) { return view.scene.background.alpha == 255; });
}

}  // namespace

Result<void> check_size(const Picture& picture) {
  const auto [least, greatest] = std::minmax(picture.width_px, picture.height_px);
  if (least >= kMinPictureSidePx && greatest <= kMaxPictureSidePx) return {};
  return failure(ExitCode::kWrongUsage,
                 fmt::format("A picture of {} x {} pixels cannot be drawn: each side is {} to {} pixels",
                             picture.width_px, picture.height_px, kMinPictureSidePx, kMaxPictureSidePx));
}

int drawn_width_px(const Picture& picture) {
  return kSupersampling * picture.width_px;
}

int drawn_height_px(const Picture& picture) {
  return kSupersampling * picture.height_px;
}

Result<Image> draw_in(vtkRenderWindow& window, const Picture& picture) {
  (void)gl::take_vtk_error();  // of what was drawn before
  add_flat_layers(window, picture);
  for (const View& view : picture.views) {
    window.AddRenderer(to_renderer(view, picture));
  }
  window.Render();
  Image pixels = read_pixels(window, drawn_width_px(picture), drawn_height_px(picture));
  if (is_opaque(picture)) pixels.make_opaque();  // what VTK leaves in alpha depends on its passes
  while (vtkRenderer* renderer = window.GetRenderers()->GetFirstRenderer()) window.RemoveRenderer(renderer);
  if (const std::string error = gl::take_vtk_error(); !error.empty())
    return failure(ExitCode::kWrongUsage, "The picture cannot be drawn; VTK says: " + error);
  return shrink_premultiplied(pixels, kSupersampling);
}

Result<Image> draw(const Picture& picture) {
  return check_size(picture)
      .and_then(
          [&] { return gl::OffscreenWindow::create(drawn_width_px(picture), drawn_height_px(picture)); })
      .and_then([&](gl::OffscreenWindow&& offscreen) { return draw_in(offscreen.window(), picture); });
}

}  // namespace sweepscope
