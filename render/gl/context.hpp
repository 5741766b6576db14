#pragma once

#include <memory>
#include <string>

#include "core/error.hpp"

namespace sweepscope::gl {

/// An OpenGL core-profile context (3.3 or later) with a default framebuffer. All drawing uses this interface,
/// with or without a window. At most one context is current on a thread.
class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context() = default;

  /// Makes the context current on this thread; a no-op if it already is.
  virtual void make_current() = 0;
  virtual void release() = 0;
  virtual bool is_current() const = 0;

  /// Of the default framebuffer.
  virtual int width_px() const = 0;
  virtual int height_px() const = 0;
  /// Shows the default framebuffer; a no-op without a window.
  virtual void present() = 0;

  /// The renderer, for example "llvmpipe (LLVM 15.0.6, 256 bits)".
  virtual std::string renderer() const = 0;
};

/// A context in memory, drawn by the CPU: needs neither a display nor a GPU. The back ends are chosen at run
/// time, in one program: OSMesa is loaded here and never linked, and bound to the same OpenGL entry points
/// that a window would use. Fails with ExitCode::kWrongUsage and a sentence that says what to install if
/// libOSMesa or libGLdispatch is missing or has an unknown version.
Result<std::unique_ptr<Context>> make_offscreen_context(int width_px, int height_px);

/// Checks that such a context can be made, with the same errors, before long work that ends with drawing.
Result<void> check_offscreen();

}  // namespace sweepscope::gl
