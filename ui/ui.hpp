#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "render/gl/context.hpp"
#include "render/images/image.hpp"
#include "ui/host/input.hpp"
#include "ui/model/explorer.hpp"

namespace sweepscope::ui {

/// The explorer's interface: the same one in a window and in memory. Frames are asked for one by one; equal
/// events at equal times give equal pixels.
class Ui {
 public:
  struct Options {
    Explorer::Options explorer;
    double display_scale = 1;           // 1 at 100 %
    std::filesystem::path recent_list;  // empty: none is kept
  };
  /// The context must outlive it.
  Ui(gl::Context& context, Options options);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  Explorer& explorer();
  const Explorer& explorer() const;

  /// Draws the interface into the context's default framebuffer. At most as many events as
  /// events_of_next_frame says.
  void frame(std::span<const InputEvent> events, double seconds_since_last);
  /// What the last frame drew.
  Image screenshot();

  bool wants_quit() const;
  /// Whether the pictures of the maps show all that there is to show at the moment.
  bool pictures_done() const;
  /// Whether the next frame would differ without any event: something moves or is being drawn. Progress of
  /// work in the background is not meant.
  bool animates() const;
  /// Where something is that can be clicked: "button estimate", "handle a", "map b", ...
  std::optional<PixelRect> anchor(const std::string& name) const;
  std::vector<std::string> anchor_names() const;

  /// Text that was copied and that pasting takes.
  std::string& clipboard();
  void set_display_scale(double scale);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace sweepscope::ui
