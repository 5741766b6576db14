#include "app/interrupt.hpp"

#include <semaphore.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <ctime>
#include <string_view>
#include <thread>

#include "core/error.hpp"
#include "core/io/temporary_file.hpp"

namespace sweepscope::app {
namespace {

std::atomic<bool> interrupted{false}, at_once{false}, unhurried{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");
sem_t signals;  // one post for each signal

extern "C" void on_signal(int) {
  interrupted = true;
  sem_post(&signals);
}

void wait_for_signal() {
  while (sem_wait(&signals) != 0) {
  }
}

// At most so long; what returned before is another signal.
void wait_for_second_signal(int max_s) {
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += max_s;
  while (sem_timedwait(&signals, &until) != 0 && errno == EINTR) {
  }
}

[[noreturn]] void end() {
  remove_unfinished_files();
  const std::string_view words =
      isatty(STDERR_FILENO) == 1 ? "\r\x1b[Ksweepscope: interrupted\n" : "sweepscope: interrupted\n";
  if (write(STDERR_FILENO, words.data(), words.size()) < 0) {
    // Nobody listens.
  }
  _exit(static_cast<int>(ExitCode::kInterrupted));
}

void watch() {
  constexpr int kGrace_s = 5;
  wait_for_signal();
  if (unhurried)
    wait_for_signal();
  else if (!at_once)
    wait_for_second_signal(kGrace_s);
  end();
}

void install() {
  sem_init(&signals, 0, 0);
  std::thread(watch).detach();
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    // A program begun with nohup or in the background of a script is not to be interrupted.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  static const bool installed = (install(), true);
  (void)installed;
  return interrupted;
}

void end_at_first_interrupt() {
  at_once = true;
  if (interrupt_flag()) sem_post(&signals);  // it came before: the watch may already wait for a second one
}

void finish_after_first_interrupt() {
  unhurried = true;
  interrupt_flag();
}

}  // namespace sweepscope::app
