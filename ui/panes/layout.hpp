#pragma once

#include <vector>

#include "render/drawing/drawing.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The positions of the parts of the interface, in pixels. A part that is not shown has no width.
struct Places {
  PixelRect menu, left, right, maps, playback, criteria, tabs, message, status;
  PixelRect sheet;  // the panel that lies over the maps
};

/// For a drawing of this size; `scale` is 1 at 100 %. Without a recording there are no side panels. A message
/// of that height gets a strip of its own, so that it covers nothing. A window without room for panels has a
/// row of tabs, which open them over the maps.
Places lay_out(double width_px, double height_px, double scale, const Settings& settings, bool has_recording,
               double message_px);

/// The panes of the maps: each has a header above its picture. B's is empty if only one is shown.
struct MapPlaces {
  PixelRect header_a, picture_a, header_b, picture_b;
};
/// `share`: that of map A where the maps stand side by side, or one above the other.
MapPlaces lay_out_maps(const PixelRect& maps, double scale, Layout layout, double share = 0.5);

/// The close-ups inside a map's picture, at its lower right: one, or in a swipe that of A and that of B.
/// They fill the fraction of its height that the map spares, if that is more. Empty where a picture is too
/// small for them.
std::vector<PixelRect> close_up_places(const PixelRect& picture, double scale, Layout layout,
                                       double spare_height = 0);

/// A above B in place of side by side, where the maps' place is as narrow as a phone.
Layout shown_layout(Layout wanted, const PixelRect& maps, double scale);

}  // namespace sweepscope::ui
