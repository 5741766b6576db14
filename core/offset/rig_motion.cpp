#include "core/offset/rig_motion.hpp"

#include "core/offset/still_motion.hpp"

namespace sweepscope {

MotionTest test_motion(const PreparedRecording& prepared) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  return test_motion(still_grid(problem), 0);
}

std::vector<MotionPart> motion_over_time(const PreparedRecording& prepared) {
  const OffsetProblem problem = problem_for(prepared, 0, 0);
  return motion_over_time(still_grid(problem), 0);
}

}  // namespace sweepscope
