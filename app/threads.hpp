#pragma once

#include <tbb/global_control.h>

#include <cstddef>
#include <memory>

namespace sweepscope::app {

/// Holds the program to `wanted` threads while the returned object lives, or to as many as can be started,
/// where a limit of processes or of memory (ulimit -u, ulimit -v) leaves fewer: TBB has no way to go on
/// without a thread that it counts on. 0 wants as many as there are processors.
std::unique_ptr<tbb::global_control> limit_threads(std::size_t wanted = 0);

}  // namespace sweepscope::app
