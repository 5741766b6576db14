#pragma once

namespace sweepscope::app {

/// For a program that goes on: what is let go goes back to the system at once.
void return_memory();

/// For a program that ends soon: what is let go is used again, as fresh pages cost more than what fills them.
void reuse_memory();

}  // namespace sweepscope::app
