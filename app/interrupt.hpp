#pragma once

#include <atomic>

namespace sweepscope::app {

/// From the first call on, ctrl-C (SIGINT) and SIGTERM set the flag instead of ending the program; a second
/// one ends it at once. Give it to Job::obey.
const std::atomic<bool>& interrupt_flag();

}  // namespace sweepscope::app
