#pragma once

#include <memory>
#include <string_view>

#include "core/error.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// A target for pictures. The same picture gives the same pixels in memory and in a window.
class Canvas {
 public:
  virtual ~Canvas() = default;
  /// A size beyond the limits is ExitCode::kWrongUsage.
  virtual Result<Image> draw(const Picture& picture) = 0;
};

enum class Backend {
  kOffscreen,  // in memory: needs no display
  kWindow,     // in a window on the desktop, which shows the picture while it is drawn
  kNull,       // nowhere: only the background, for tests of everything but pixels
};

/// "offscreen", "window" or "null"; an unknown name is ExitCode::kWrongUsage.
Result<Backend> backend(std::string_view name);

/// Fails with a sentence if the back end is not available, such as a window without a display.
Result<std::unique_ptr<Canvas>> make_canvas(Backend backend);

}  // namespace sweepscope
