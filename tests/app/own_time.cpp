// Preloaded into a program under test, it gives it a time of its own, so that no test waits for a clock or is
// hurried by one: the steady clock advances by 1 ms with each read of standard input and stands still
// otherwise, and a wait for a semaphore with a time limit is over at once.
#include <dlfcn.h>
#include <semaphore.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

namespace {

std::atomic<long> passed_ms{0};

}  // namespace

extern "C" {

ssize_t read(int descriptor, void* data, size_t size) {
  static auto* const real = reinterpret_cast<ssize_t (*)(int, void*, size_t)>(dlsym(RTLD_NEXT, "read"));
  if (descriptor == STDIN_FILENO) ++passed_ms;
  return real(descriptor, data, size);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static auto* const real =
      reinterpret_cast<int (*)(clockid_t, timespec*)>(dlsym(RTLD_NEXT, "clock_gettime"));
  if (clock != CLOCK_MONOTONIC) return real(clock, time);
  *time = {passed_ms / 1000, passed_ms % 1000 * 1'000'000};
  return 0;
}

int sem_timedwait(sem_t*, const timespec*) {
  errno = ETIMEDOUT;
  return -1;
}

}  // extern "C"
