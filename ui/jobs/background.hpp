#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/job.hpp"
#include "ui/jobs/task_progress.hpp"

namespace sweepscope::ui {

/// The status of a background task, for display.
struct JobStatus {
  std::string key, title, phase;
  double fraction = 0;       // of the whole task, never falling
  double seconds_left = -1;  // below 0: not known yet
  bool running = false;      // otherwise it is queued
};

/// Long work beside the interface. Each lane is a thread that runs its tasks in order. The function that a
/// task returns is called later by take_finished, on the calling thread: so only one thread touches the
/// explorer's state.
class Background {
 public:
  using Finish = std::function<void()>;
  using Work = std::function<Finish(const Job& job)>;

  Background();
  ~Background();  // cancels and waits
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// From now on its threads, and those that they start, have a lower priority than the interface.
  /// Before anything is started.
  void come_after_the_interface();
  /// `wake` is called, from any thread, when a task finished or progressed.
  void on_progress(std::function<void()> wake);
  /// `plan`: the steps of the task and what part of its time each takes (see TaskProgress).
  void start(const std::string& lane, const std::string& key, const std::string& title, Work work,
             std::vector<TaskStep> plan = {});
  /// Whether a task with this key is queued or running, and not cancelled.
  bool has(const std::string& key) const;
  /// Its result is dropped, even if it is finished but not taken yet.
  void cancel(const std::string& key);
  /// All tasks whose key has this prefix; "" for all.
  void cancel_all(const std::string& prefix);
  std::vector<std::string> keys(const std::string& prefix) const;
  /// Calls the functions that finished tasks returned, in the order in which they finished.
  void take_finished();

  bool has_finished() const;  // anything that take_finished would take
  bool busy() const;          // any task that is queued, running, or not taken
  std::size_t started()
      const;  // tasks, since the beginning: a short one may be taken in the frame that starts it
  std::vector<JobStatus> status() const;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace sweepscope::ui
