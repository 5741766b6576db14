#include "app/threads.hpp"

#include <tbb/task_arena.h>

#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace sweepscope::app {
namespace {

/// How many threads can run beside this one, at most so many: they are started, and end at once.
std::size_t startable(std::size_t most) {
  std::atomic<bool> over{false};
  std::vector<std::thread> threads;
  threads.reserve(most);
  try {
    while (threads.size() < most) threads.emplace_back([&over] { over.wait(false); });
  } catch (const std::system_error&) {
    // No more than these.
  }
  over = true;
  over.notify_all();
  for (std::thread& thread : threads) thread.join();
  return threads.size();
}

}  // namespace

std::unique_ptr<tbb::global_control> limit_threads(std::size_t wanted) {
  if (wanted == 0) wanted = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               1 + startable(wanted - 1));
}

}  // namespace sweepscope::app
