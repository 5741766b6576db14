#include "app/threads.hpp"

#include <pthread.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace sweepscope::app {
namespace {

void* wait_until_over(void* over) {
  static_cast<std::atomic<bool>*>(over)->wait(false);
  return nullptr;
}

/// How many threads can run beside this one, at most so many: they are started, and end at once. Not by
/// std::thread: each would take address space for memory of its own, which may be what is short.
std::size_t startable(std::size_t max_threads) {
  std::atomic<bool> over{false};
  std::vector<pthread_t> threads;
  threads.reserve(max_threads);
  for (pthread_t thread{};
       threads.size() < max_threads && pthread_create(&thread, nullptr, wait_until_over, &over) == 0;)
    threads.push_back(thread);
  over = true;
  over.notify_all();
  for (const pthread_t thread : threads) pthread_join(thread, nullptr);
  return threads.size();
}

}  // namespace

std::unique_ptr<tbb::global_control> limit_threads(std::size_t wanted) {
  if (wanted == 0) wanted = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  // One is left over: TBB may start a thread before one that it has ended is gone.
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               std::max<std::size_t>(startable(wanted), 1));
}

}  // namespace sweepscope::app
