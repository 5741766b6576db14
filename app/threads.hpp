#pragma once

#include <tbb/global_control.h>

#include <cstddef>
#include <memory>

namespace sweepscope::app {

/// Limits the program to `wanted` threads while the returned object lives, or to as many as can be started if
/// a limit of processes or of memory (ulimit -u, ulimit -v) allows fewer: TBB cannot continue without a
/// thread that it relies on. 0: as many as there are processors.
std::unique_ptr<tbb::global_control> limit_threads(std::size_t wanted = 0);

}  // namespace sweepscope::app
