#include "render/comparison/scene_depth.hpp"

namespace sweepscope {

View with_depth(View view, const DepthLook& look, const Style& style) {
  constexpr double kGridStep_px = 70, kRadius_px = 2, kLetters_px = 12, kScanner_px = 22;
  Scene& scene = view.scene;
  const ShownCues shown = cues_in(scene.camera, look.cues);
  for (CloudLayer& layer : scene.clouds) layer.splats = shown.splats;
  if (shown.lighting) {
    const double splat_px = scene.clouds.empty() ? 1 : scene.clouds.front().point_size_px;
    scene.lighting = Lighting{.radius_px = kRadius_px * look.scale, .splat_px = splat_px};
  }
  if (shown.grid) {
    scene.grid = ground_grid(look.box, Projection(scene.camera, view.place), kGridStep_px * look.scale);
    scene.grid->line_px = look.scale;
    scene.grid->text_px = kLetters_px * look.scale;
    scene.grid->lines = scene.grid->text = style.map_highlight;
    scene.grid->lines.alpha = 40;
    scene.grid->text.alpha = 150;
  }
  if (shown.scanner && look.scanner)
    scene.scanner = ScannerMark{*look.scanner, kScanner_px * look.scale, style.map_highlight};
  return view;
}

}  // namespace sweepscope
