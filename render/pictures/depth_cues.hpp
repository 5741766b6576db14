#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "render/pictures/camera.hpp"

namespace sweepscope {

/// Whether something is drawn: where the view suits it, always, or never.
enum class Switch { kAuto, kOn, kOff };
inline constexpr std::array<std::string_view, 3> kSwitchNames{"auto", "on", "off"};
/// An unknown name is ExitCode::kWrongUsage; the message lists the known names.
Result<Switch> switch_named(std::string_view name);

/// What makes depth visible in a picture of points.
struct DepthCues {
  Switch lighting = Switch::kAuto;                                               // everywhere but in plans
  Switch splats = Switch::kAuto, grid = Switch::kAuto, scanner = Switch::kAuto;  // with the lighting

  bool operator==(const DepthCues&) const = default;
};

/// Those that a view has.
struct ShownCues {
  bool lighting = false, splats = false, grid = false, scanner = false;
  bool operator==(const ShownCues&) const = default;
};

/// A parallel projection from straight above: a plan, as the paper's figures are.
bool is_plan(const Camera& camera);
ShownCues cues_in(const Camera& camera, const DepthCues& cues);

/// One cue as an option, declared once: the command line, recipes and the explorer's commands come from it.
struct DepthCueOption {
  std::string name, title, help;
  Switch DepthCues::*cue;
};
std::span<const DepthCueOption> depth_cue_options();

}  // namespace sweepscope
