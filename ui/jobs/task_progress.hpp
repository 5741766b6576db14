#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sweepscope::ui {

/// A step of a task, by the name that the work reports, and the share of the task's time that it takes.
struct TaskStep {
  std::string phase;
  double share = 0;
};

/// One fraction for a whole task, made of the fractions of its steps: it never falls, and it reaches 1 only
/// at the end. Steps come in the order of the plan and may be left out; one that repeats has several entries.
/// A step that is not planned takes half of what is left, so that there is always something left for the
/// next.
class TaskProgress {
 public:
  TaskProgress() = default;
  explicit TaskProgress(std::vector<TaskStep> plan) : plan_(std::move(plan)) {}

  void report(std::string_view phase, double fraction);
  /// In [0, 1], of the task's time.
  double fraction() const { return fraction_; }
  const std::string& phase() const { return phase_; }

 private:
  void begin_step(std::string_view phase);

  std::vector<TaskStep> plan_;
  std::size_t next_ = 0;  // in the plan
  std::string phase_;
  double in_step_ = 0;                    // the fraction reported last
  double step_begin_ = 0, step_end_ = 0;  // of the whole
  double fraction_ = 0;
};

}  // namespace sweepscope::ui
