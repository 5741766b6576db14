#pragma once

#include <atomic>

namespace sweepscope::app {

/// From the first call on, ctrl-C (SIGINT), SIGTERM and SIGHUP set the flag instead of ending the program.
/// Give it to Job::obey. Where the program does not end within 5 s of that, or at a second signal, it is
/// ended: unfinished files are removed, one sentence is printed, the exit code is ExitCode::kInterrupted.
const std::atomic<bool>& interrupt_flag();

/// For work that does not look at the flag: from now on the first signal ends the program like that.
void end_at_first_interrupt();

/// For work whose first interruption ends a part of it, and whose result is then made of what there is: from
/// now on it takes a second signal to end the program like that, however long the rest takes.
void finish_after_first_interrupt();

}  // namespace sweepscope::app
