#include "render/pictures/live_view.hpp"

#include <vtk_glew.h>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkPixelBufferObject.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextureObject.h>

#include <algorithm>
#include <chrono>

#include "render/clouds/point_polydata.hpp"
#include "render/clouds/splats.hpp"
#include "render/gl/read_framebuffer.hpp"
#include "render/gl/vtk_window.hpp"
#include "render/pictures/depth_scale.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kActorPoints = 32768;

/// A cloud cut into actors, which are made when they are first drawn.
struct Slices {
  LivePointsPtr points;
  std::vector<vtkSmartPointer<vtkActor>> actors;
  bool wants_splats = false, splats = false;  // splats: the points have what it takes

  void forget(vtkRenderer& renderer) { reset(points, renderer); }

  void reset(LivePointsPtr next, vtkRenderer& renderer) {
    for (const auto& actor : actors) {
      if (actor) renderer.RemoveActor(actor);
    }
    splats = wants_splats && next && next->spacing_m.size() == next->size();
    points = std::move(next);
    actors.assign(points ? (points->size() + kActorPoints - 1) / kActorPoints : 0, nullptr);
  }
  /// Stays in the renderer, invisible between drawings: VTK uploads the points of an actor again if it was
  /// removed.
  vtkActor* at(std::size_t slice, const SplatSizes& sizes, vtkRenderer& renderer) {
    if (!actors[slice]) {
      const std::size_t from = slice * kActorPoints, count = std::min(kActorPoints, points->size() - from);
      vtkNew<vtkPolyDataMapper> mapper;
      const std::span<const float> spacing_m =
          splats ? std::span(points->spacing_m).subspan(from, count) : std::span<const float>();
      mapper->SetInputData(to_polydata(std::span(points->xyz_m).subspan(from, count),
                                       std::span(points->rgb).subspan(from, count), spacing_m));
      mapper->SetColorModeToDirectScalars();
      mapper->StaticOn();
      actors[slice] = vtkSmartPointer<vtkActor>::New();
      actors[slice]->SetMapper(mapper);
      if (splats) add_splats(*actors[slice], *mapper);
      actors[slice]->GetProperty()->LightingOff();
      renderer.AddActor(actors[slice]);
    }
    actors[slice]->GetProperty()->SetPointSize(static_cast<float>(sizes.min_px));
    if (splats) set_splat_sizes(*actors[slice], sizes);
    return actors[slice];
  }
};

/// A copy of a finished picture: what is shown while the next one is collected.
class KeptPicture {
 public:
  /// The window's picture as it is.
  void keep(vtkGenericOpenGLRenderWindow& window) {
    const int* size_px = window.GetSize();
    const auto width_px = static_cast<unsigned>(size_px[0]), height_px = static_cast<unsigned>(size_px[1]);
    make_texture(window);
    if (texture_->GetWidth() != width_px || texture_->GetHeight() != height_px)
      texture_->Allocate2D(width_px, height_px, Image::kChannels, VTK_UNSIGNED_CHAR);
    vtkOpenGLFramebufferObject& drawn = *window.GetDisplayFramebuffer();
    window.GetState()->PushReadFramebufferBinding();
    drawn.Bind(vtkOpenGLFramebufferObject::GetReadMode());
    drawn.ActivateReadBuffer(0);
    texture_->CopyFromFrameBuffer(0, 0, 0, 0, size_px[0], size_px[1]);
    texture_->Deactivate();
    window.GetState()->PopReadFramebufferBinding();
    valid_ = true;
  }
  /// A picture with its rows from the bottom.
  void keep(vtkGenericOpenGLRenderWindow& window, Image& rows) {
    make_texture(window);
    texture_->Create2DFromRaw(static_cast<unsigned>(rows.width_px), static_cast<unsigned>(rows.height_px),
                              Image::kChannels, VTK_UNSIGNED_CHAR, rows.rgba.data());
    texture_->Deactivate();
    valid_ = true;
  }
  void forget() { valid_ = false; }
  bool valid() const { return valid_; }
  unsigned handle() const { return texture_ ? texture_->GetHandle() : 0; }
  void release(vtkWindow& window) {
    if (texture_) texture_->ReleaseGraphicsResources(&window);
  }

  Image image() const {
    if (!texture_) return {};
    Image image(static_cast<int>(texture_->GetWidth()), static_cast<int>(texture_->GetHeight()));
    const auto pixels = vtk::TakeSmartPointer(texture_->Download());
    std::vector<std::uint8_t> rows(image.rgba.size());
    unsigned size_px[2] = {texture_->GetWidth(), texture_->GetHeight()};
    vtkIdType increments[2] = {0, 0};
    pixels->Download2D(VTK_UNSIGNED_CHAR, rows.data(), size_px, Image::kChannels, increments);
    const std::size_t row_bytes = Image::kChannels * static_cast<std::size_t>(image.width_px);
    for (int y = 0; y < image.height_px; ++y)
      std::copy_n(rows.data() + row_bytes * static_cast<std::size_t>(image.height_px - 1 - y), row_bytes,
                  image.pixel(0, y));
    image.make_opaque();
    return image;
  }

 private:
  void make_texture(vtkGenericOpenGLRenderWindow& window) {
    if (texture_) return;
    texture_ = vtkSmartPointer<vtkTextureObject>::New();
    texture_->SetContext(&window);
  }

  vtkSmartPointer<vtkTextureObject> texture_;
  bool valid_ = false;
};

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

struct LiveView::Parts {
  explicit Parts(gl::Context& gl_context)
      : context(gl_context), window(gl::make_vtk_window(gl_context, 64, 64)) {
    window->AddRenderer(renderer);
    renderer->GetActiveCamera()->ParallelProjectionOn();
  }

  ~Parts() {
    context.make_current();
    for (KeptPicture* picture : {&coarse_picture, &full_picture}) picture->release(*window);
    window->Finalize();
  }

  /// Some slices, or an empty picture if there are none.
  void render(std::span<vtkActor* const> actors, bool clear) {
    for (vtkActor* actor : actors) actor->VisibilityOn();
    renderer->SetErase(clear);
    apply_camera();
    const SplatsOn splats_on(coarse.splats || full.splats);
    const bool wants_depth = lighting || transparent, had_depth = glIsEnabled(GL_DEPTH_TEST) == GL_TRUE;
    if (wants_depth) use_depth(true);
    window->Render();
    if (wants_depth && !had_depth) use_depth(false);
    for (vtkActor* actor : actors) actor->VisibilityOff();
  }

  /// Windows of one context, and the interface, keep accounts of its state that do not match.
  void use_depth(bool on) {
    vtkOpenGLState& state = *window->GetState();
    state.ResetEnumState(GL_DEPTH_TEST);
    state.ResetGLDepthMaskState();
    if (on)
      state.vtkglEnable(GL_DEPTH_TEST);
    else
      state.vtkglDisable(GL_DEPTH_TEST);
    state.vtkglDepthMask(GL_TRUE);
  }

  void apply_camera() {
    vtkCamera& out = *renderer->GetActiveCamera();
    out.SetPosition(camera.position_m.data());
    out.SetFocalPoint(camera.looks_at_m.data());
    out.SetViewUp(camera.up.data());
    out.SetParallelProjection(camera.orthographic);
    out.SetParallelScale(camera.view_height_m / 2);
    out.SetViewAngle(camera.view_angle_deg);
    // The same for every slice, or the depths of one would not compare with those of another.
    if (bounds[0] <= bounds[1]) renderer->ResetCameraClippingRange(bounds.data());
  }

  void find_bounds() {
    bounds = {1, -1, 1, -1, 1, -1};
    for (const LivePoints* points : {coarse.points.get(), full.points.get()}) {
      if (points == nullptr) continue;
      for (const auto& p : points->xyz_m) {
        if (bounds[0] > bounds[1]) bounds = {p[0], p[0], p[1], p[1], p[2], p[2]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          bounds[2 * axis] = std::min(bounds[2 * axis], static_cast<double>(p[axis]));
          bounds[2 * axis + 1] = std::max(bounds[2 * axis + 1], static_cast<double>(p[axis]));
        }
      }
    }
  }

  void begin_again() {
    drawn = 0;
    coarse_picture.forget();
    full_picture.forget();
  }
  std::size_t wanted() const { return 1 + (moving ? 0 : full.actors.size()); }
  /// All coarse points at once, as each drawing takes a millisecond or two besides its points; then a slice.
  /// The empty picture comes first, alone: VTK draws what comes with it with the depth test on, and the
  /// rest without.
  void draw_next() {
    const std::size_t step = drawn++;
    if (step > 0) return render(std::array{full.at(step - 1, splat_sizes(), *renderer)}, false);
    std::vector<vtkActor*> actors;
    for (std::size_t i = 0; i < coarse.actors.size(); ++i)
      actors.push_back(coarse.at(i, splat_sizes(), *renderer));
    render({}, true);
    render(actors, false);
  }
  void keep_what_is_whole() {
    if (drawn == 1 && !coarse_picture.valid()) keep(coarse_picture);
    if (full.points && drawn == 1 + full.actors.size() && !full_picture.valid()) keep(full_picture);
  }
  void keep(KeptPicture& picture) {
    if (!lighting && !transparent) return picture.keep(*window);
    colours = gl::read_colours(*window, std::move(colours));
    depths = gl::read_depths(*window, std::move(depths));
    if (lighting)
      colours = with_lighting(std::move(colours), depths,
                              depth_scale(*renderer, camera, window->GetSize()[1]), *lighting);
    if (transparent) colours = without_gaps(std::move(colours), depths);
    picture.keep(*window, colours);
  }
  SplatSizes splat_sizes() const {
    return {pixels_per_metre(camera, window->GetSize()[1]), point_size_px, kMaxSplatGrowth * point_size_px};
  }
  void use_splats(bool on) {
    for (Slices* slices : {&coarse, &full}) {
      slices->wants_splats = on;
      slices->forget(*renderer);
    }
  }

  gl::Context& context;
  vtkSmartPointer<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  Slices coarse, full;
  Camera camera;
  double point_size_px = 1;
  Colour background{0, 0, 0};
  bool moving = false;
  std::array<double, 6> bounds{1, -1, 1, -1, 1, -1};
  std::size_t drawn = 0;  // of the coarse points together and the full slices
  KeptPicture coarse_picture, full_picture;
  std::optional<Lighting> lighting;
  bool splats = false, transparent = false;
  Image colours;      // read back, to be lit
  DepthImage depths;  // kept for their memory
};

LiveView::LiveView(gl::Context& context) : parts_(std::make_unique<Parts>(context)) {}
LiveView::~LiveView() = default;

void LiveView::resize(int width_px, int height_px) {
  if (width_px == this->width_px() && height_px == this->height_px()) return;
  parts_->window->SetSize(width_px, height_px);
  parts_->begin_again();
}

void LiveView::show(LivePointsPtr coarse, LivePointsPtr full) {
  if (coarse == parts_->coarse.points && full == parts_->full.points) return;
  const bool only_more = coarse == parts_->coarse.points && parts_->full.points == nullptr;
  if (coarse != parts_->coarse.points) parts_->coarse.reset(std::move(coarse), *parts_->renderer);
  if (full != parts_->full.points) parts_->full.reset(std::move(full), *parts_->renderer);
  const auto before = parts_->bounds;
  parts_->find_bounds();
  if (!only_more || before != parts_->bounds) parts_->begin_again();
}

void LiveView::set_camera(const Camera& camera) {
  const Camera& now = parts_->camera;
  if (camera.position_m == now.position_m && camera.looks_at_m == now.looks_at_m && camera.up == now.up &&
      camera.orthographic == now.orthographic && camera.view_height_m == now.view_height_m)
    return;
  parts_->camera = camera;
  parts_->begin_again();
}

void LiveView::set_point_size(double size_px) {
  if (size_px == parts_->point_size_px) return;
  parts_->point_size_px = size_px;
  parts_->begin_again();
}

void LiveView::set_background(Colour colour) {
  if (colour == parts_->background) return;
  parts_->background = colour;
  parts_->renderer->SetBackgroundAlpha(1);
  parts_->renderer->SetBackground(colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0);
  parts_->begin_again();
}

void LiveView::set_lighting(const std::optional<Lighting>& lighting) {
  if (lighting == parts_->lighting) return;
  parts_->lighting = lighting;
  parts_->begin_again();
}

void LiveView::set_splats(bool on) {
  if (on == parts_->splats) return;
  parts_->splats = on;
  parts_->use_splats(on);
  parts_->begin_again();
}

void LiveView::set_transparent(bool on) {
  if (on == parts_->transparent) return;
  parts_->transparent = on;
  parts_->begin_again();
}

void LiveView::set_moving(bool moving) {
  parts_->moving = moving;
}

void LiveView::draw(double budget_s) {
  Parts& p = *parts_;
  p.context.make_current();
  const double end_s = now_s() + budget_s;
  const bool begins = p.drawn == 0;
  if (begins) p.draw_next();
  p.keep_what_is_whole();
  if (begins && now_s() >= end_s) return;
  while (!done()) {
    p.draw_next();
    p.keep_what_is_whole();
    if (now_s() >= end_s) return;
    // What only waits to be drawn has taken no time yet: it would pile up, and a later frame would wait for
    // all.
    p.window->WaitForCompletion();
  }
}

bool LiveView::done() const {
  return parts_->drawn >= parts_->wanted();
}

bool LiveView::has_all_points() const {
  return parts_->full_picture.valid();
}

unsigned LiveView::texture(Points points) const {
  const bool all = points == Points::kAll && has_all_points();
  return (all ? parts_->full_picture : parts_->coarse_picture).handle();
}

Image LiveView::picture(Points points) const {
  parts_->context.make_current();
  const bool all = points == Points::kAll && has_all_points();
  return (all ? parts_->full_picture : parts_->coarse_picture).image();
}

int LiveView::width_px() const {
  return parts_->window->GetSize()[0];
}

int LiveView::height_px() const {
  return parts_->window->GetSize()[1];
}

}  // namespace sweepscope
