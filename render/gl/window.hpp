#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/error.hpp"
#include "render/gl/context.hpp"

namespace sweepscope::gl {

/// The events of a window. Positions are in pixels of its framebuffer, keys and modifiers are GLFW's.
struct WindowEvents {
  std::function<void(double x, double y)> moved;
  std::function<void(int button, bool down, int modifiers)> pressed;
  std::function<void(double clicks)> scrolled;
  std::function<void(int key, bool down, int modifiers)> key;
  std::function<void(unsigned code_point)> typed;
  std::function<void(const std::string& path)> dropped;
  std::function<void()> changed;  // size, scale, or it was uncovered: draw again
};

enum class Cursor { kArrow, kHand, kText, kResizeX };

/// A window on the desktop with its own context.
class Window : public Context {
 public:
  WindowEvents events;

  /// Processes events: waits for one, at most this long (0: not at all).
  virtual void wait(double max_s) = 0;
  /// Whether it was asked to close since this was asked for.
  virtual bool take_close() = 0;
  /// Of the display: 1 at 100 %.
  virtual double scale() const = 0;
  virtual void set_title(const std::string& title) = 0;
  virtual void set_cursor(Cursor cursor) = 0;
  virtual std::string clipboard() const = 0;
  virtual void set_clipboard(const std::string& text) = 0;
};

/// Fails with ExitCode::kWrongUsage and a sentence if there is no display, or it has no OpenGL 3.3. Only on
/// the main thread.
Result<std::unique_ptr<Window>> make_window(int width_px, int height_px, const std::string& title);

/// Of the primary display: 1 at 100 %, and without a display. Only on the main thread.
double display_scale();

/// Ends a wait() early; from any thread.
void wake_window();

}  // namespace sweepscope::gl
