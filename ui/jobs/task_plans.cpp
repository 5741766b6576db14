#include "ui/jobs/task_plans.hpp"

namespace sweepscope::ui {
namespace {

/// The walk's offset and trajectory, found together. Most walks need one pass, the others go on in what is
/// left.
std::vector<TaskStep> steps_of_walk() {
  return {{"searching", 3}, {"searching", 0.3}, {"tracking", 3}, {"adjusting", 12}};
}

std::vector<TaskStep> followed_by(std::vector<TaskStep> steps, std::vector<TaskStep> more) {
  steps.insert(steps.end(), more.begin(), more.end());
  return steps;
}

}  // namespace

std::vector<TaskStep> steps_of_loading() {
  std::vector<TaskStep> steps{{"unpacking", 0.2}, {"reading", 1}};
  for (int i = 0; i < 6; ++i)  // each reading of the beams that is tried
    steps = followed_by(std::move(steps), {{"features", 0.1}, {"searching", 0.3}});
  return followed_by(steps, {{"reading its streams", 0.2}, {"features", 1}, {"the first map", 0.5}});
}

std::vector<TaskStep> steps_of_surveying() {
  return {{"unpacking", 0.2}, {"reading", 1}, {"features", 1}};
}

std::vector<TaskStep> steps_of_simulating() {
  return {{"casting", 4}, {"reading its streams", 0.2}, {"features", 1}, {"the first map", 0.5}};
}

std::vector<TaskStep> steps_of_solving() {
  return followed_by(steps_of_walk(), {{"placing", 1}});
}

std::vector<TaskStep> steps_of_estimating() {
  return followed_by(steps_of_walk(), {{"comparing", 1}});
}

std::vector<TaskStep> steps_of_reporting() {
  return followed_by(steps_of_walk(), {{"comparing", 1}, {"placing", 1}, {"drawing", 2}});
}

}  // namespace sweepscope::ui
