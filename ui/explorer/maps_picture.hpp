#pragma once

#include <string>
#include <utility>

#include "render/pictures/picture.hpp"
#include "ui/explorer/explorer.hpp"

namespace sweepscope::ui {

/// What a picture of the maps shows beside them.
struct FigureParts {
  bool offsets = true, legend = true, scale = true, close_up = true;

  bool operator==(const FigureParts&) const = default;
};
/// "offsets,legend", or "none"; unknown words are ExitCode::kWrongUsage.
Result<FigureParts> parse_figure_parts(const std::string& words);
std::string to_words(const FigureParts& parts);

inline constexpr const char* kUsualFigureSize = "1920x1200";
/// "3840x2400", as `compare --size` takes it.
Result<std::pair<int, int>> parse_figure_size(const std::string& size);

/// The maps that the layout shows (of a swipe: both) as a picture of any size, with labels, legend, scale and
/// axes, smooth edges and all points that are placed; close-ups below them where there is a place to show.
/// What the panes show lies within the views; `pane_aspect`: their width over height. Sizes as `compare`
/// takes them, or ExitCode::kWrongUsage.
Result<Picture> maps_picture(const Explorer& explorer, int width_px, int height_px, double pane_aspect,
                             const FigureParts& parts);

}  // namespace sweepscope::ui
