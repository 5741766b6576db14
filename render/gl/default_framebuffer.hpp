#pragma once

#include <string>

#include "render/gl/context.hpp"
#include "render/images/colour_table.hpp"
#include "render/images/image.hpp"

namespace sweepscope::gl {

/// Makes the context current and its default framebuffer the one that is drawn to, all of it in one colour.
void begin_default_framebuffer(Context& context, Colour colour);

/// What draws with the current context.
std::string renderer_of_current();

/// Waits until everything is drawn.
void finish_drawing(Context& context);

/// What the default framebuffer holds.
Image read_default_framebuffer(Context& context);

}  // namespace sweepscope::gl
