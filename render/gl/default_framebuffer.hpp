#pragma once

#include <string>

#include "render/gl/context.hpp"
#include "render/images/colour_table.hpp"
#include "render/images/image.hpp"

namespace sweepscope::gl {

/// Makes the context current and its default framebuffer the target, filled with one colour.
void begin_default_framebuffer(Context& context, Colour colour);

/// The renderer of the current context.
std::string renderer_of_current();

/// Waits until everything is drawn.
void finish_drawing(Context& context);

/// The content of the default framebuffer.
Image read_default_framebuffer(Context& context);

}  // namespace sweepscope::gl
