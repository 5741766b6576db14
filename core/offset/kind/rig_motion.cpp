#include "core/offset/kind/rig_motion.hpp"

#include "core/offset/kind/stationary_motion.hpp"

namespace sweepscope {

MotionTest test_motion(const PreparedRecording& prepared) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  return test_motion(stationary_grid(problem), 0);
}

std::vector<MotionPart> motion_over_time(const PreparedRecording& prepared) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  return motion_over_time(stationary_grid(problem), 0);
}

}  // namespace sweepscope
