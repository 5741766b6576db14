#pragma once

#include <vector>

#include "ui/model/task_progress.hpp"

namespace sweepscope::ui {

/// The steps of the explorer's long tasks, by the names that they report, and the parts of the time that they
/// took for 60 s of a simulated walk (`sweepscope simulate metro-station --duration-s 60`).
std::vector<TaskStep> steps_of_loading();
std::vector<TaskStep> steps_of_simulating();
std::vector<TaskStep> steps_of_solving();
std::vector<TaskStep> steps_of_estimating();
std::vector<TaskStep> steps_of_reporting();

}  // namespace sweepscope::ui
