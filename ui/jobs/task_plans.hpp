#pragma once

#include <vector>

#include "ui/jobs/task_progress.hpp"

namespace sweepscope::ui {

/// The steps of the explorer's long tasks, by the names that they report, and roughly the parts of the time
/// that they take for a walk of a minute. They set how evenly a bar moves, and nothing else.
std::vector<TaskStep> steps_of_loading();
std::vector<TaskStep> steps_of_surveying();
std::vector<TaskStep> steps_of_simulating();
std::vector<TaskStep> steps_of_solving();
std::vector<TaskStep> steps_of_estimating();
std::vector<TaskStep> steps_of_reporting();

}  // namespace sweepscope::ui
