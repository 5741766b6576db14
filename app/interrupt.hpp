#pragma once

#include <atomic>

namespace sweepscope::app {

/// After the first call, Ctrl-C (SIGINT), SIGTERM and SIGHUP set the flag instead of ending the program. Pass
/// it to Job::obey. If the program does not end within 5 s, or at a second signal, it is terminated:
/// unfinished files are removed, one sentence is printed, and the exit code is ExitCode::kInterrupted.
const std::atomic<bool>& interrupt_flag();

/// For work that does not check the flag: from now on the first signal terminates the program in this way.
void end_at_first_interrupt();

/// For work whose first interruption ends only a part of it, with a result from the rest: from now on only a
/// second signal terminates the program in this way, without a time limit.
void finish_after_first_interrupt();

}  // namespace sweepscope::app
