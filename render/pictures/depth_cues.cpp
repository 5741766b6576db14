#include "render/pictures/depth_cues.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace sweepscope {

Result<Switch> switch_named(std::string_view name) {
  const auto found = std::find(kSwitchNames.begin(), kSwitchNames.end(), name);
  if (found != kSwitchNames.end()) return static_cast<Switch>(found - kSwitchNames.begin());
  return failure(ExitCode::kWrongUsage, fmt::format("{} is needed", fmt::join(kSwitchNames, ", ")));
}

bool is_plan(const Camera& camera) {
  const Eigen::Vector3d forward = (camera.looks_at_m - camera.position_m).normalized();
  return camera.orthographic && forward.z() < -1 + 1e-9;
}

ShownCues cues_in(const Camera& camera, const DepthCues& cues) {
  const auto shown = [](Switch chosen, bool automatic) {
    return chosen == Switch::kAuto ? automatic : chosen == Switch::kOn;
  };
  const bool lit = shown(cues.lighting, !is_plan(camera));
  return {lit, shown(cues.splats, lit), shown(cues.grid, lit), shown(cues.scanner, lit)};
}

std::span<const DepthCueOption> depth_cue_options() {
  static const std::vector<DepthCueOption> options{
      {"lighting", "Lighting",
       "Edges and corners are shaded by the depth of the points: auto (everywhere but in parallel views from "
       "above), on or off",
       &DepthCues::lighting},
      {"splats", "Splats",
       "Sparse points are drawn larger, to close surfaces: auto (with lighting), on or off",
       &DepthCues::splats},
      {"grid", "Ground grid", "A grid below the map, with metres: auto (with lighting), on or off",
       &DepthCues::grid},
      {"scanner", "Scanner",
       "The scanner and its scanning plane at the last visible time: auto (with lighting), on or off",
       &DepthCues::scanner}};
  return options;
}

}  // namespace sweepscope
