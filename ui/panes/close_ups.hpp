#pragma once

#include <vector>

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// Where they lie in a map's picture: see close_up_places. Empty without a place to show.
std::vector<PixelRect> close_ups_in(const PaneContext& context, const PixelRect& picture);

/// The close-up of a map in a corner of its picture: the place where the maps differ most, from above. Drawn
/// over the picture; nothing if there is no place.
void draw_close_up(const PaneContext& context, Side side, const PixelRect& picture);

/// The frame of the close-up's place on a map.
void draw_place_mark(const PaneContext& context, const Projection& projection);

/// A list of the places, to choose from.
void place_field(const PaneContext& context);

}  // namespace sweepscope::ui
