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
#include <vtkOpenGLRenderWindow.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/parallel.hpp"

#include "render/clouds/point_polydata.hpp"
#include "render/clouds/splats.hpp"
#include "render/drawing/vtk_drawing.hpp"
#include "render/gl/read_framebuffer.hpp"
#include "render/gl/vtk_window.hpp"
#include "render/pictures/depth_scale.hpp"

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
  // NOLINTNEXTLINE(bugprone-derived-method-shadowing-base-method): as every class of VTK does.
  vtkTypeMacro(PatientMapper, vtkOpenGLPolyDataMapper)

      void RenderPieceFinish(vtkRenderer* renderer, vtkActor* actor) override {
    Superclass::RenderPieceFinish(renderer, actor);
    glFinish();
  }
};
vtkStandardNewMacro(PatientMapper);

/// The layer in slices, in its own order.
void add_actors(const CloudLayer& layer, const Scene& scene, double view_height_px, vtkRenderer& renderer) {
  const auto rgb = colours_of(*layer.points, scene.colours);
  const std::vector<float> spacing_m = layer.splats ? spacing_of(layer.points->xyz_m) : std::vector<float>();
  const double size_px = layer.point_size_px * kSupersampling;
  for (std::size_t from = 0; from < rgb.size(); from += kSlicePoints) {
    const std::size_t count = std::min(kSlicePoints, rgb.size() - from);
    vtkNew<PatientMapper> mapper;
    mapper->SetInputData(
        to_polydata(std::span(layer.points->xyz_m).subspan(from, count), std::span(rgb).subspan(from, count),
                    layer.splats ? std::span(spacing_m).subspan(from, count) : std::span<const float>()));
    mapper->SetColorModeToDirectScalars();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetPointSize(static_cast<float>(size_px));
    if (layer.splats) {
      add_splats(*actor, *mapper);
      set_splat_sizes(*actor, {pixels_per_metre(scene.camera, view_height_px * kSupersampling), size_px,
                               kMaxSplatGrowth * size_px});
    }
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
    if (layer.points) add_actors(layer, view.scene, view.place.height, *renderer);
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

void remove_renderers(vtkRenderWindow& window) {
  while (vtkRenderer* renderer = window.GetRenderers()->GetFirstRenderer()) window.RemoveRenderer(renderer);
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

bool has_splats(const Picture& picture) {
  return std::any_of(picture.views.begin(), picture.views.end(), [](const View& view) {
    return std::any_of(view.scene.clouds.begin(), view.scene.clouds.end(),
                       [](const CloudLayer& layer) { return layer.splats; });
  });
}

/// Views with depth are drawn in steps: the points, which are lit; what lies below them; the marks above.
bool has_depth(const Picture& picture) {
  return has_splats(picture) || std::any_of(picture.views.begin(), picture.views.end(), [](const View& view) {
           return view.scene.lighting || view.scene.grid;
         });
}

/// Where a view lies among the pixels that are drawn, rows from the bottom.
struct DrawnRect {
  int left = 0, bottom = 0, width = 0, height = 0;
};

DrawnRect drawn_rect(const PixelRect& place, int width_px, int height_px) {
  const auto drawn = [](double px, int max_px) {
    return std::clamp(static_cast<int>(std::lround(kSupersampling * px)), 0, max_px);
  };
  const int left = drawn(place.left, width_px), right = drawn(place.right(), width_px),
            top = drawn(place.top, height_px), bottom = drawn(place.bottom(), height_px);
  return {left, height_px - bottom, right - left, bottom - top};
}

/// A view's part of the pixels, lit.
Image lit_part(const Image& pixels, const DepthImage& depths, const DrawnRect& rect, const DepthScale& scale,
               Lighting lighting) {
  Image part(rect.width, rect.height);
  DepthImage part_depths(rect.width, rect.height);
  for (int y = 0; y < rect.height; ++y) {
    std::copy_n(pixels.pixel(rect.left, rect.bottom + y),
                Image::kChannels * static_cast<std::size_t>(rect.width), part.pixel(0, y));
    std::copy_n(depths.row(rect.bottom + y) + rect.left, rect.width, part_depths.row(y));
  }
  lighting.radius_px *= kSupersampling;
  lighting.splat_px *= kSupersampling;
  return with_lighting(std::move(part), part_depths, scale, lighting);
}

void paste(Image& pixels, const Image& part, const DrawnRect& rect) {
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(part.pixel(0, y), Image::kChannels * static_cast<std::size_t>(rect.width),
                pixels.pixel(rect.left, rect.bottom + y));
}

/// A drawing alone, its colours multiplied by alpha.
Image drawn_alone(vtkOpenGLRenderWindow& window, Drawing drawing) {
  vtkNew<vtkRenderer> renderer;
  set_background(*renderer, {0, 0, 0, 0});
  renderer->AddActor(make_drawing_actor(std::make_shared<const Drawing>(std::move(drawing)), kSupersampling));
  window.AddRenderer(renderer);
  window.Render();
  Image image = gl::read_colours(window);
  window.RemoveRenderer(renderer);
  return image;
}

/// The upper pixels over the lower ones, or only where there is no point; all multiplied by alpha.
void cover(Image& lower, const Image& upper, const DepthImage* gaps_of) {
  for_each_block(lower.height_px, 16, [&](const auto& rows) {
    for (int y = rows.begin(); y < rows.end(); ++y) {
      const float* depth = gaps_of != nullptr ? gaps_of->row(y) : nullptr;
      for (int x = 0; x < lower.width_px; ++x) {
        const std::uint8_t* from = upper.pixel(x, y);
        if (from[3] == 0 || (depth != nullptr && depth[x] < DepthImage::kEmpty)) continue;
        std::uint8_t* to = lower.pixel(x, y);
        for (std::size_t channel = 0; channel < Image::kChannels; ++channel)
          to[channel] = static_cast<std::uint8_t>(
              std::min(255, from[channel] + (to[channel] * (255 - from[3]) + 127) / 255));
      }
    }
  });
}

Drawing grids_of(const Picture& picture) {
  Drawing drawing;
  for (const View& view : picture.views) {
    if (!view.scene.grid) continue;
    const Camera& camera = view.scene.camera;
    drawing.add_all(grid_marks(*view.scene.grid, camera, Projection(camera, view.place)));
  }
  return drawing;
}

/// Rows from the top.
Image upright(const Image& image) {
  Image out(image.width_px, image.height_px);
  for (int y = 0; y < image.height_px; ++y)
    std::copy_n(image.pixel(0, image.height_px - 1 - y),
                Image::kChannels * static_cast<std::size_t>(image.width_px), out.pixel(0, y));
  return out;
}

Image draw_with_depth(vtkOpenGLRenderWindow& window, const Picture& picture) {
  window.SetNumberOfLayers(1);
  vtkNew<vtkRenderer> below;
  set_background(*below, picture.background);
  window.AddRenderer(below);
  std::vector<vtkSmartPointer<vtkRenderer>> renderers;
  for (const View& view : picture.views) {
    renderers.push_back(to_renderer(view, picture));
    window.AddRenderer(renderers.back());
  }
  {
    const SplatsOn splats_on(has_splats(picture));
    window.Render();
  }
  Image pixels = gl::read_colours(window);
  const DepthImage depths = gl::read_depths(window);
  for (std::size_t i = 0; i < renderers.size(); ++i) {
    const View& view = picture.views[i];
    if (!view.scene.lighting) continue;
    const DrawnRect rect = drawn_rect(view.place, pixels.width_px, pixels.height_px);
    const DepthScale scale = depth_scale(*renderers[i], view.scene.camera, rect.height);
    paste(pixels, lit_part(pixels, depths, rect, scale, *view.scene.lighting), rect);
  }
  remove_renderers(window);
  if (is_opaque(picture)) pixels.make_opaque();
  const Drawing grids = grids_of(picture);
  if (!grids.marks().empty()) cover(pixels, drawn_alone(window, grids), &depths);
  cover(pixels, drawn_alone(window, flat_marks(picture)), nullptr);
  return upright(pixels);
}

Image draw_flat(vtkRenderWindow& window, const Picture& picture) {
  add_flat_layers(window, picture);
  for (const View& view : picture.views) {
    window.AddRenderer(to_renderer(view, picture));
  }
  window.Render();
  Image pixels = read_pixels(window, drawn_width_px(picture), drawn_height_px(picture));
  if (is_opaque(picture)) pixels.make_opaque();  // what VTK leaves in alpha depends on its passes
  remove_renderers(window);
  return pixels;
}

}  // namespace

Result<void> check_size(const Picture& picture) {
  const auto [min, max] = std::minmax(picture.width_px, picture.height_px);
  if (min >= kMinPictureSidePx && max <= kMaxPictureSidePx) return {};
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
  auto* with_framebuffer = vtkOpenGLRenderWindow::SafeDownCast(&window);
  const Image pixels = with_framebuffer != nullptr && has_depth(picture)
                           ? draw_with_depth(*with_framebuffer, picture)
                           : draw_flat(window, picture);
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
