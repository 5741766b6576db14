#include "ui/jobs/task_progress.hpp"

#include <algorithm>

namespace sweepscope::ui {

void TaskProgress::report(std::string_view phase, double fraction) {
  constexpr double kRestart = 0.3;  // threads report out of order, but not by that much
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (phase != phase_ || fraction < in_step_ - kRestart) begin_step(phase);
  in_step_ = fraction;
  fraction_ = std::max(fraction_, step_begin_ + fraction * (step_end_ - step_begin_));
}

void TaskProgress::begin_step(std::string_view phase) {
  phase_ = phase;
  step_begin_ = fraction_;
  step_end_ = (1 + fraction_) / 2;
  double total = 0, before = 0;
  for (const TaskStep& step : plan_) total += step.share;
  for (std::size_t i = 0; i < plan_.size(); ++i) {
    if (i >= next_ && plan_[i].phase == phase) {
      next_ = i + 1;
      step_begin_ = std::max(fraction_, before / total);
      step_end_ = std::max(step_begin_, (before + plan_[i].share) / total);
      return;
    }
    before += plan_[i].share;
  }
}

}  // namespace sweepscope::ui
