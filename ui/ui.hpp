#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "render/gl/context.hpp"
#include "render/images/image.hpp"
#include "ui/explorer/explorer.hpp"
#include "ui/host/input.hpp"

namespace sweepscope::ui {

/// The explorer's interface: the same in a window and in memory. Frames are requested one by one; equal
/// events at equal times give equal pixels.
class Ui {
 public:
  struct Options {
    Explorer::Options explorer;
    double display_scale = 1;           // 1 at 100 %
    bool scale_given = false;           // by a person: a window's display does not change it
    std::filesystem::path recent_list;  // empty: none is kept
    std::filesystem::path preferences;  // the same
    double draw_budget_s = 0.012;       // of each map and frame, for points beyond the coarse ones
  };
  /// The context must outlive it.
  Ui(gl::Context& context, Options options);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  Explorer& explorer();
  const Explorer& explorer() const;

  /// Takes the events and places everything, without drawing it. Events that do not fit into one frame wait
  /// for the next ones.
  void frame(std::span<const InputEvent> events, double seconds_since_last);
  /// Draws the last frame into the context's default framebuffer.
  void paint();
  /// The picture of the last frame.
  Image screenshot();

  /// As the command does. While a file is written, the first time announces that the window closes after
  /// it, and the second time stops the writing.
  void quit();
  bool wants_quit() const;
  /// Whether events wait for a frame.
  bool has_input() const;
  /// Whether a file is still to be written.
  bool is_exporting() const;
  /// Whether the pictures of the maps are complete.
  bool pictures_done() const;
  /// Whether the maps are shown with all their points, rather than thinned.
  bool shows_all_points() const;
  /// Whether the next frame would differ without any event, because something moves or is being drawn.
  /// Progress of background work does not count.
  bool animates() const;
  /// The position of something that can be clicked: "button estimate", "handle a", "map b", ...
  std::optional<PixelRect> anchor(const std::string& name) const;
  std::vector<std::string> anchor_names() const;

  /// The clipboard.
  std::string& clipboard();
  void set_display_scale(double scale);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sweepscope::ui
