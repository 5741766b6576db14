#include "ui/jobs/background.hpp"

#include <sys/resource.h>
#include <tbb/task_scheduler_observer.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "core/io/printable_text.hpp"

namespace sweepscope::ui {
namespace {

using Clock = std::chrono::steady_clock;

struct Task {
  std::string lane, key, title;
  Background::Work work;
  std::unique_ptr<Job> job;
  Background::Finish finish;
  bool running = false, finished = false, cancelled = false;
  TaskProgress progress;
  Clock::time_point began;
};
using TaskPtr = std::shared_ptr<Task>;

double seconds_left(const Task& task) {
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - task.began).count();
  const double fraction = task.progress.fraction();
  if (!task.running || fraction < 0.05 || elapsed_s < 0.5) return -1;
  return elapsed_s * (1 - fraction) / fraction;
}

/// Makes the threads that work with the present one come after those that draw, for good: only root could
/// take it back.
class ComingAfter : public tbb::task_scheduler_observer {
 public:
  ComingAfter() {
    on_scheduler_entry(false);
    observe(true);
  }
  ~ComingAfter() override { observe(false); }
  void on_scheduler_entry(bool) override {
    constexpr int kNice = 10;
    const auto thread = static_cast<id_t>(gettid());  // of this thread alone, on Linux
    if (getpriority(PRIO_PROCESS, thread) < kNice) (void)setpriority(PRIO_PROCESS, thread, kNice);
  }
};

}  // namespace

struct Background::Shared {
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::deque<TaskPtr> tasks;  // in the order of their start; taken out once finished and taken
  std::function<void()> wake;
  std::size_t started = 0;
  bool ending = false, comes_after = false;
  std::map<std::string, std::thread> lanes;

  TaskPtr next_in(const std::string& lane) {
    for (const TaskPtr& task : tasks) {
      if (task->lane == lane && !task->running && !task->finished) return task;
    }
    return nullptr;
  }

  void run_lane(const std::string& lane) {
    std::unique_lock lock(mutex);
    std::optional<ComingAfter> after;
    if (comes_after) after.emplace();
    while (true) {
      TaskPtr task;
      changed.wait(lock, [&] { return ending || (task = next_in(lane)) != nullptr; });
      if (ending) return;
      task->running = true;
      task->began = Clock::now();
      lock.unlock();
      // A thread that throws would end the program: the next taker of results throws instead.
      Finish finish;
      try {
        if (!task->job->cancelled()) finish = task->work(*task->job);
      } catch (...) {
        finish = [thrown = std::current_exception()] { std::rethrow_exception(thrown); };
      }
      lock.lock();
      task->finish = std::move(finish);
      task->work = nullptr;
      task->running = false;
      task->finished = true;
      if (wake) wake();
    }
  }

  void report(Task& task, std::string_view phase, double fraction) {
    const std::lock_guard lock(mutex);
    task.progress.report(phase, fraction);
    if (wake) wake();
  }
};

Background::Background() : shared_(std::make_unique<Shared>()) {}

Background::~Background() {
  cancel_all("");
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->ending = true;
    shared_->wake = nullptr;
  }
  shared_->changed.notify_all();
  for (auto& [lane, thread] : shared_->lanes) thread.join();
}

void Background::come_after_the_interface() {
  const std::lock_guard lock(shared_->mutex);
  shared_->comes_after = true;
}

void Background::on_progress(std::function<void()> wake) {
  const std::lock_guard lock(shared_->mutex);
  shared_->wake = std::move(wake);
}

void Background::start(const std::string& lane, const std::string& key, const std::string& title, Work work,
                       std::vector<TaskStep> plan) {
  auto task = std::make_shared<Task>();
  task->lane = lane;
  task->key = key;
  task->title = printable_line(title);
  task->work = std::move(work);
  task->progress = TaskProgress(std::move(plan));
  task->job = std::make_unique<Job>([this, raw = task.get()](std::string_view phase, double fraction) {
    shared_->report(*raw, phase, fraction);
  });
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->tasks.push_back(std::move(task));
    ++shared_->started;
    if (!shared_->lanes.contains(lane))
      shared_->lanes.emplace(lane, std::thread([shared = shared_.get(), lane] { shared->run_lane(lane); }));
  }
  shared_->changed.notify_all();
}

std::size_t Background::started() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->started;
}

bool Background::has(const std::string& key) const {
  const std::lock_guard lock(shared_->mutex);
  return std::any_of(shared_->tasks.begin(), shared_->tasks.end(),
                     [&](const TaskPtr& task) { return task->key == key && !task->cancelled; });
}

void Background::cancel(const std::string& key) {
  const std::lock_guard lock(shared_->mutex);
  for (const TaskPtr& task : shared_->tasks) {
    if (task->key != key) continue;
    task->cancelled = true;
    task->job->cancel();
  }
}

void Background::cancel_all(const std::string& prefix) {
  for (const std::string& key : keys(prefix)) cancel(key);
}

std::vector<std::string> Background::keys(const std::string& prefix) const {
  const std::lock_guard lock(shared_->mutex);
  std::vector<std::string> found;
  for (const TaskPtr& task : shared_->tasks) {
    if (task->key.starts_with(prefix) && !task->cancelled) found.push_back(task->key);
  }
  return found;
}

void Background::take_finished() {
  while (true) {
    TaskPtr task;
    {
      const std::lock_guard lock(shared_->mutex);
      const auto done = std::find_if(shared_->tasks.begin(), shared_->tasks.end(),
                                     [](const TaskPtr& t) { return t->finished; });
      if (done == shared_->tasks.end()) return;
      task = *done;
      shared_->tasks.erase(done);
    }
    if (task->finish && !task->cancelled) task->finish();
  }
}

bool Background::has_finished() const {
  const std::lock_guard lock(shared_->mutex);
  return std::any_of(shared_->tasks.begin(), shared_->tasks.end(),
                     [](const TaskPtr& task) { return task->finished; });
}

bool Background::busy() const {
  const std::lock_guard lock(shared_->mutex);
  return std::any_of(shared_->tasks.begin(), shared_->tasks.end(),
                     [](const TaskPtr& task) { return !task->cancelled; });
}

std::vector<JobStatus> Background::status() const {
  const std::lock_guard lock(shared_->mutex);
  std::vector<JobStatus> all;
  for (const TaskPtr& task : shared_->tasks) {
    if (task->cancelled || task->finished) continue;
    all.push_back({task->key, task->title, task->progress.phase(), task->progress.fraction(),
                   seconds_left(*task), task->running});
  }
  return all;
}

}  // namespace sweepscope::ui
