// Drawing against a bare VTK render of the same points. Run by hand: build/bin/sweepscope_render_benchmark
#include <benchmark/benchmark.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "core/numbers.hpp"
#include "render/clouds/point_polydata.hpp"
#include "render/comparison/comparison.hpp"
#include "render/gl/default_framebuffer.hpp"
#include "render/gl/vtk_window.hpp"
#include "render/pictures/live_view.hpp"
#include "render/pictures/picture.hpp"
#include "tests/render/synthetic_maps.hpp"

namespace sweepscope {
namespace {

using benchmark::State;

constexpr std::size_t kPoints = 2'000'000;

/// Two maps of a hall, in the order of time, as files hold them.
const std::vector<ComparedMap>& maps() {
  static const std::vector<ComparedMap> made = [] {
    std::vector<ComparedMap> both(2);
    both[0].cloud = test::HallMap(0.03, kPoints).make();
    both[1].cloud = test::HallMap(0, kPoints).make();
    return both;
  }();
  return made;
}

ComparisonOptions all_heights() {
  ComparisonOptions options;
  options.slabs = {{-100, 100}};
  options.with_close_up = false;
  return options;
}

vtkSmartPointer<vtkPolyData> bare(const MapCloud& cloud) {
  std::vector<std::array<float, 3>> xyz_m;
  std::vector<std::array<std::uint8_t, 3>> rgb;
  xyz_m.reserve(cloud.size());
  rgb.reserve(cloud.size());
  for (const MapPoint& point : cloud) {
    xyz_m.push_back({point.x, point.y, point.z});
    rgb.push_back({static_cast<std::uint8_t>(40 * (static_cast<double>(point.z) + 2)), 128, 200});
  }
  return to_polydata(xyz_m, rgb);
}

/// One frame of both maps side by side at the size at which pictures are drawn, data conversion included.
void bare_vtk_render(State& state) {
  for (auto _ : state) {
    auto offscreen = gl::OffscreenWindow::create(3840, 2400).value();
    for (std::size_t m = 0; m < 2; ++m) {
      vtkNew<vtkPolyDataMapper> mapper;
      mapper->SetInputData(bare(*maps()[m].cloud));
      mapper->SetColorModeToDirectScalars();
      vtkNew<vtkActor> actor;
      actor->SetMapper(mapper);
      actor->GetProperty()->LightingOff();
      actor->GetProperty()->SetPointSize(2);
      vtkNew<vtkRenderer> renderer;
      renderer->SetViewport(0.5 * static_cast<double>(m), 0, 0.5 * static_cast<double>(m + 1), 1);
      renderer->AddActor(actor);
      renderer->GetActiveCamera()->SetParallelProjection(true);
      renderer->ResetCamera();
      offscreen.window().AddRenderer(renderer);
    }
    offscreen.window().Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    offscreen.window().GetRGBACharPixelData(0, 0, 3839, 2399, 0, pixels);
    benchmark::DoNotOptimize(pixels->GetPointer(0));
  }
}

/// The whole comparison: heights, colours, spatial order, thinning, marks, drawing and shrinking.
void comparison(State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(comparison_picture(maps(), nullptr, all_heights()).and_then(draw).value());
  }
}

/// Its drawing alone, from a picture that is made.
void drawing(State& state) {
  const Picture picture = comparison_picture(maps(), nullptr, all_heights()).value();
  for (auto _ : state) benchmark::DoNotOptimize(draw(picture).value());
}

/// A hall of 1 million points in an isometric view of 1280 x 720.
class HallView {
 public:
  HallView(gl::Context& context, const LivePointsPtr& points) : context_(context), view_(context) {
    view_.resize(1280, 720);
    view_.set_point_size(2);
    view_.set_camera(camera_on({{-16, -8, -1.3}, {16, 8, 3.7}}, Viewpoint::kIsometric, true, 1280.0 / 720));
    view_.show(points, nullptr);
  }
  LiveView& view() { return view_; }
  /// Draws it anew; seconds.
  double draw() {
    view_.set_background({0, 0, shade_ = static_cast<std::uint8_t>(shade_ ^ 1)});
    const auto begin = std::chrono::steady_clock::now();
    view_.draw(60);
    gl::finish_drawing(context_);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

 private:
  gl::Context& context_;
  LiveView view_;
  std::uint8_t shade_ = 0;
};

/// What lighting adds to a drawing: flat and lit in turn, so that a machine that becomes slower meets both.
void lighting(State& state) {
  auto points = std::make_shared<LivePoints>();
  const auto hall = test::HallMap(0, 1'000'000).make();
  for (const MapPoint& point : *hall) {
    points->xyz_m.push_back({point.x, point.y, point.z});
    points->rgb.push_back({90, 160, 120});
  }
  const auto context = gl::make_offscreen_context(64, 64).value();
  HallView flat(*context, points), lit(*context, points);
  lit.view().set_lighting(Lighting{});
  flat.draw();
  lit.draw();
  std::vector<double> flat_ms, added_ms;
  for (auto _ : state) {
    flat_ms.push_back(1e3 * flat.draw());
    added_ms.push_back(1e3 * lit.draw() - flat_ms.back());
  }
  state.counters["flat_ms"] = median(flat_ms);
  state.counters["lighting_ms"] = median(added_ms);
}

BENCHMARK(lighting)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(101);
BENCHMARK(bare_vtk_render)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Iterations(5);
BENCHMARK(comparison)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime()->Iterations(5);
BENCHMARK(drawing)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime()->Iterations(5);

}  // namespace
}  // namespace sweepscope

BENCHMARK_MAIN();
