#pragma once

#include <string>

namespace sweepscope::test {

/// The environment of a program into which a module is preloaded.
inline std::string preloaded(const std::string& module) {
  return "ASAN_OPTIONS=\"$ASAN_OPTIONS:verify_asan_link_order=0\" LD_PRELOAD='" + module + "'";
}

/// When the program sends a signal to itself: no clock decides how far it is by then (see
/// signal_itself.cpp). Once it has written `words`, or renamed a file to a name with them, so many
/// times; with no words as soon as it handles the signal.
struct SelfSignal {
  int signal = 0;
  std::string words;
  int times = 1;

  /// As `run_program` takes it. What a script begins in its background ignores SIGINT: not here.
  std::string environment() const {
    return "--default-signal -u DISPLAY " + preloaded(SWEEPSCOPE_SIGNAL_ITSELF) +
           " SIGNAL_ITSELF=" + std::to_string(signal) + " SIGNAL_ITSELF_AT='" + words +
           "' SIGNAL_ITSELF_TIMES=" + std::to_string(times);
  }
};

/// The exit code that a shell gives for a program that SIGKILL ended.
constexpr int kKilled = 137;

}  // namespace sweepscope::test
