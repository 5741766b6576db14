#pragma once

#include <memory>
#include <string>

#include "core/error.hpp"

namespace sweepscope::gl {

/// An OpenGL core-profile context (3.3 or later) with a default framebuffer. Everything that draws asks for
/// one of these and need not know whether a window is behind it. At most one is current on a thread.
class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context() = default;

  /// Makes the context current on this thread; a no-op where it is.
  virtual void make_current() = 0;
  virtual void release() = 0;
  virtual bool is_current() const = 0;

  /// Of the default framebuffer.
  virtual int width_px() const = 0;
  virtual int height_px() const = 0;
  /// Shows what the default framebuffer holds; a no-op where nobody looks.
  virtual void present() = 0;

  /// What draws, for example "llvmpipe (LLVM 15.0.6, 256 bits)".
  virtual std::string renderer() const = 0;
};

/// A context in memory, drawn by the CPU: needs neither a display nor a GPU. The back ends are chosen at run
/// time, in one program: OSMesa is loaded here and never linked, and bound to the same OpenGL entry points
/// that a window would use. Fails with ExitCode::kWrongUsage and a sentence that says what to install where
/// libOSMesa or libGLdispatch is missing or is not the one known.
Result<std::unique_ptr<Context>> make_offscreen_context(int width_px, int height_px);

/// Whether such a context can be made, by the same errors: for work that takes its time before it draws.
Result<void> check_offscreen();

}  // namespace sweepscope::gl
