#pragma once

#include <functional>
#include <optional>
#include <string>

#include "render/drawing/drawing.hpp"
#include "render/images/image.hpp"
#include "ui/explorer/maps_picture.hpp"

namespace sweepscope::ui {

/// The pictures that commands ask for. One is taken once what asked for it, a dialog or the palette, is gone
/// and the maps are drawn with all their points, and is written in the background.
class AskedPictures {
 public:
  explicit AskedPictures(Explorer& explorer) : explorer_(explorer) {}

  /// The interface, or of it the maps alone (`what` is "maps"), these at a size of their own where one is
  /// given ("3840x2400").
  Result<void> ask(const std::string& file, const std::string& what, const std::string& size);
  /// The maps as a figure; see parse_figure_parts. Empty size or parts: the usual ones.
  Result<void> ask_figure(const std::string& file, const std::string& size, const std::string& parts);

  bool waits() const { return asked_.has_value(); }
  /// Whether the next one is of the maps alone: then no buttons and tooltips lie on them.
  bool waits_for_maps() const { return asked_ && asked_->what == "maps"; }

  /// What a frame showed.
  struct Frame {
    bool is_whole = false;          // the maps have all their points, or none are shown
    std::optional<PixelRect> maps;  // where they are, if they are shown
    double pane_aspect = 1;         // width over height of a map
  };
  /// Takes the picture that waits, if it is time. `screenshot` draws the frame.
  void take(const std::function<Image()>& screenshot, const Frame& frame);

 private:
  struct Asked {
    std::string file, what, size;
    FigureParts parts = {.close_up = false};
    bool figure = false;
  };
  void wait_for(Asked asked);
  void write_maps(const Asked& asked, double pane_aspect);

  Explorer& explorer_;
  std::optional<Asked> asked_;
  int frames_to_wait_ = 0;
};

}  // namespace sweepscope::ui
