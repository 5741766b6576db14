#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/job.hpp"

namespace sweepscope::ui {

/// What a person sees of work in the background.
struct JobStatus {
  std::string key, title, phase;
  double fraction = 0;       // of the phase
  double seconds_left = -1;  // below 0: not known yet
  bool running = false;      // else it waits its turn
};

/// Long work beside the interface. Each lane is a thread that does its tasks one after the other. What a task
/// hands back is called later by take_finished, on the thread that calls that: so only one thread ever
/// touches the explorer's state.
class Background {
 public:
  using Finish = std::function<void()>;
  using Work = std::function<Finish(const Job& job)>;

  Background();
  ~Background();  // cancels and waits
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// From now on its threads, and those that help them, come after the interface where both want a processor.
  /// Before anything is started.
  void come_after_the_interface();
  /// `wake` is called from any thread when something finished or moved on.
  void on_progress(std::function<void()> wake);
  void start(const std::string& lane, const std::string& key, const std::string& title, Work work);
  /// Is there a task with this key that waits or runs and was not cancelled?
  bool has(const std::string& key) const;
  /// Its result is dropped, even where it is finished but was not taken yet.
  void cancel(const std::string& key);
  /// All whose key begins so; "" for all there are.
  void cancel_all(const std::string& prefix);
  std::vector<std::string> keys(const std::string& prefix) const;
  /// Calls what finished tasks handed back, in the order in which they finished.
  void take_finished();

  bool has_finished() const;  // anything that take_finished would take
  bool busy() const;          // anything that waits, runs, or was not taken
  std::vector<JobStatus> status() const;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace sweepscope::ui
