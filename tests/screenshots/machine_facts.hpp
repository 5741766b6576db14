#pragma once

#include <string>

#include "core/error.hpp"

namespace sweepscope::screenshots {

/// What pixels depend on, a line each: the OpenGL renderer and version (Mesa and LLVM), VTK, and the
/// processor. Fails where there is no context, or where it is not llvmpipe's: baselines are its pixels.
Result<std::string> machine_facts();

}  // namespace sweepscope::screenshots
