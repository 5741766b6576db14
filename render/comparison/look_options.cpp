#include "render/comparison/look_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

tl::unexpected<Error> wrong(const std::string& wanted) {
  return failure(ExitCode::kWrongUsage, wanted);
}

/// The numbers of a text such as "1920x1200", or nothing where it is not exactly that many.
std::optional<std::vector<double>> numbers_of(const std::string& text, char separator, std::size_t count) {
  std::vector<double> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  while (numbers.size() < count) {
    double number = 0;
    const auto [after, error] = std::from_chars(at, end, number);
    const bool last = numbers.size() + 1 == count;
    const bool complete = last ? after == end : after != end && *after == separator;
    if (error != std::errc() || !complete || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    at = after + (last ? 0 : 1);
  }
  return numbers;
}

Result<bool> switch_of(const std::string& text) {
  if (text == "true" || text.empty()) return true;
  if (text == "false") return false;
  return wrong("true or false is needed");
}

Result<void> set_size(ComparisonOptions& options, const std::string& text) {
  const auto size = numbers_of(text, 'x', 2);
  const auto fits = [](double side_px) {
    return side_px >= kMinPictureSidePx && side_px <= kMaxPictureSidePx;
  };
  if (!size || !fits((*size)[0]) || !fits((*size)[1])) {
    return wrong(fmt::format("WxH is needed, such as 1920x1200, with sides of {} to {} pixels",
                             kMinPictureSidePx, kMaxPictureSidePx));
  }
  options.width_px = static_cast<int>((*size)[0]);
  options.height_px = static_cast<int>((*size)[1]);
  return {};
}

Result<void> set_background(ComparisonOptions& options, const std::string& text) {
  const auto found = std::find(kBackgroundNames.begin(), kBackgroundNames.end(), text);
  if (found == kBackgroundNames.end()) {
    return wrong(fmt::format("there are {}", fmt::join(kBackgroundNames, ", ")));
  }
  options.background = static_cast<Background>(found - kBackgroundNames.begin());
  return {};
}

Result<void> set_colour_range(ComparisonOptions& options, const std::string& text) {
  const auto range = numbers_of(text, ':', 2);
  if (!range || !((*range)[0] < (*range)[1])) {
    return wrong("A:B is needed, such as 0:40, in the unit of the colouring");
  }
  options.colour_range = ValueRange{(*range)[0], (*range)[1]};
  return {};
}

Result<void> set_point_size(ComparisonOptions& options, const std::string& text) {
  const auto size = numbers_of(text, ':', 1);
  if (!size || (*size)[0] < 0.25 || (*size)[0] > 32) return wrong("0.25 to 32 pixels");
  options.point_size_px = (*size)[0];
  return {};
}

Result<void> set_slab(ComparisonOptions& options, const std::string& text) {
  const auto range = numbers_of(text, ':', 2);
  if (!range || !((*range)[0] < (*range)[1])) {
    return wrong("FROM:TO is needed, such as 0.8:3.2, in metres above the sensor's path");
  }
  options.slabs.push_back({(*range)[0], (*range)[1]});
  return {};
}

Result<void> set_close_up(ComparisonOptions& options, const std::string& text) {
  if (text == "none" || text == "auto") {
    options.with_close_up = text == "auto";
    options.close_up.reset();
    return {};
  }
  const auto region = numbers_of(text, ':', 3);
  if (!region || !((*region)[2] > 0)) {
    return wrong("X:Y:HEIGHT is needed, such as 12.5:-3:4 in metres, or auto or none");
  }
  options.with_close_up = true;
  options.close_up = Region{{(*region)[0], (*region)[1]}, (*region)[2]};
  return {};
}

Result<void> set_camera(ComparisonOptions& options, const std::string& text) {
  const auto camera = numbers_of(text, ':', 7);
  const char* wanted =
      "PX:PY:PZ:X:Y:Z:EXTENT is needed: where the camera is, what it looks at, and the height of the view in "
      "metres";
  if (!camera || !((*camera)[6] > 0)) return wrong(wanted);
  Camera set;
  set.position_m = {(*camera)[0], (*camera)[1], (*camera)[2]};
  set.looks_at_m = {(*camera)[3], (*camera)[4], (*camera)[5]};
  const Eigen::Vector3d forward = set.looks_at_m - set.position_m;
  if (!(forward.norm() > 1e-6)) return wrong("the camera is at the point that it looks at");
  const bool upright = forward.normalized().head<2>().norm() > 1e-3;
  set.up = upright ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, 1, 0);
  set.view_height_m = (*camera)[6];
  set.view_angle_deg = 2 * std::atan2((*camera)[6] / 2, forward.norm()) * kDegPerRad;
  options.camera = set;
  return {};
}

Result<void> set_box(ComparisonOptions& options, const std::string& text) {
  const auto box = numbers_of(text, ':', 6);
  if (!box || !((*box)[0] < (*box)[3]) || !((*box)[1] < (*box)[4]) || !((*box)[2] < (*box)[5])) {
    return wrong("X0:Y0:Z0:X1:Y1:Z1 is needed, the minimum and the maximum corner in metres");
  }
  options.box = Box{{(*box)[0], (*box)[1], (*box)[2]}, {(*box)[3], (*box)[4], (*box)[5]}};
  return {};
}

template <typename T>
Result<void> assign(T& to, Result<T> value) {
  if (!value) return tl::unexpected(value.error());
  to = std::move(*value);
  return {};
}

std::vector<LookOption> declare() {
  using Options = ComparisonOptions;
  std::vector<LookOption> options{
      {"size", "WxH", "Size of the picture in pixels (default: 1920x1200)", false, set_size},
      {"title", "TEXT", "Title above the maps (default: the recording's name)", false,
       [](Options& o, const std::string& text) { return o.title = text, Result<void>(); }},
      {"background", "NAME", "dark, light (dark behind points), white or transparent (default: dark)", false,
       set_background},
      {"colour-by", "NAME",
       "elevation, intensity, time, direction (which way the motor turned), features (edge and plane "
       "points), blur (the thickness of the surface around a point) or distance (to the other map) (default: "
       "elevation)",
       false, [](Options& o, const std::string& text) { return assign(o.colour_by, colour_by(text)); }},
      {"colour-table", "NAME", "viridis, cividis, turbo or grey (default: viridis)", false,
       [](Options& o, const std::string& text) {
         return colour_table(text).map([&](const ColourTable&) { o.colour_table = text; });
       }},
      {"colour-range", "A:B", "Values at the ends of the colour table (default: from the points shown)",
       false, set_colour_range},
      {"point-size", "PX", "Size of a point in pixels at 1920x1200 (default: 1)", false, set_point_size},
      {"viewpoint", "NAME", "top, front (along y), right (along -x) or isometric (default: top)", false,
       [](Options& o, const std::string& text) { return assign(o.viewpoint, viewpoint(text)); }},
      {"perspective", "", "Perspective projection (default: parallel projection)", false,
       [](Options& o, const std::string& text) { return assign(o.perspective, switch_of(text)); }},
      {"camera", "PX:PY:PZ:X:Y:Z:EXTENT",
       "Instead of a viewpoint: the camera at P looks at X:Y:Z, where the view is EXTENT metres high", false,
       set_camera},
      {"box", "X0:Y0:Z0:X1:Y1:Z1", "Show only this box of the map frame, in metres, as large as possible",
       false, set_box},
      {"slab", "FROM:TO",
       "Show only these heights, in metres above the sensor's path; repeatable (default from above: at least "
       "0.8 m below it, and from 0.8 m above it to just under the ceiling)",
       true, set_slab},
      {"close-up", "X:Y:HEIGHT",
       "Centre and height of the close-ups, in metres of the map frame; or none (default: auto, where the "
       "maps differ most in sharpness)",
       false, set_close_up},
  };
  for (const DepthCueOption& option : depth_cue_options())
    options.push_back({option.name, "WHEN", option.help + " (default: auto)", false,
                       [cue = option.cue](Options& o, const std::string& text) {
                         return assign(o.cues.*cue, switch_named(text));
                       }});
  return options;
}

}  // namespace

std::span<const LookOption> look_options() {
  static const std::vector<LookOption> options = declare();
  return options;
}

Result<void> set_look(ComparisonOptions& options, const LookOption& option, const std::string& text) {
  return option.set(options, text).map_error([&](Error error) {
    error.message = fmt::format("{}{}{}: {}", option.name, text.empty() ? "" : " ", text, error.message);
    return error;
  });
}

const LookOption* find_look_option(std::string_view name) {
  for (const LookOption& option : look_options()) {
    if (option.name == name) return &option;
  }
  return nullptr;
}

}  // namespace sweepscope
