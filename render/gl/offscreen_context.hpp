#pragma once

#include "render/gl/context.hpp"

namespace sweepscope::gl {

/// A context in memory whose size can change, as a window's does.
class OffscreenContext : public Context {
 public:
  /// What was drawn is lost. The context is not current afterwards.
  virtual void resize(int width_px, int height_px) = 0;
};

/// As make_offscreen_context, with the same errors.
Result<std::unique_ptr<OffscreenContext>> make_resizable_context(int width_px, int height_px);

}  // namespace sweepscope::gl
