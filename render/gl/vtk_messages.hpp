#pragma once

#include <string>

namespace sweepscope::gl {

/// From the first call on VTK keeps its warnings and errors to itself, instead of writing them to stderr.
void quiet_vtk();

/// The first error that VTK met on this thread since it was last asked for; empty where there was none.
std::string take_vtk_error();

}  // namespace sweepscope::gl
