#pragma once

#include <memory>
#include <span>
#include <string>

#include "render/gl/context.hpp"
#include "render/images/image.hpp"
#include "ui/host/input.hpp"
#include "ui/host/theme.hpp"

struct ImGuiContext;

namespace sweepscope::ui {

/// Dear ImGui on an OpenGL context, with or without a window: it takes our own events and draws into the
/// default framebuffer.
class ImGuiHost {
 public:
  /// The context must outlive it.
  explicit ImGuiHost(gl::Context& context);
  ~ImGuiHost();
  ImGuiHost(const ImGuiHost&) = delete;
  ImGuiHost& operator=(const ImGuiHost&) = delete;

  /// Fonts, margins and colours for a display's scale; no effect if they are already set.
  void use(Theme theme, double scale);
  const Fonts& fonts() const { return fonts_; }

  /// Whether arrows, Enter and Escape move through what is in front.
  void navigate_by_keys(bool on);
  /// Enter does what Space does there: it presses what the arrows went to.
  bool enter_chooses = false;
  /// The events must fit into one frame: see InputQueue.
  void begin_frame(std::span<const InputEvent> events, double seconds_since_last);
  /// What the panes made is ready to be drawn.
  void end_frame(Colour background);
  /// Draws it into the default framebuffer. No effect before the first frame.
  void paint();

  /// The clipboard; a window connects it with the system's.
  std::string clipboard;

 private:
  gl::Context& context_;
  ImGuiContext* imgui_;
  Fonts fonts_;
  Colour background_;
  Theme theme_ = Theme::kDark;
  double scale_ = 0;
};

}  // namespace sweepscope::ui
