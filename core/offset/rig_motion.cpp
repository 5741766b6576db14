#include "core/offset/rig_motion.hpp"

#include "core/offset/search_window.hpp"
#include "core/offset/still_motion.hpp"

namespace sweepscope {

Result<MotionTest> test_motion(const Recording& recording, const Job& job) {
  const auto problem = prepare_problem(recording, 0, 0, {}, job);
  if (!problem) return tl::unexpected(problem.error());
  return test_motion(still_grid(*problem), 0);
}

}  // namespace sweepscope
