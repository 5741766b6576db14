#include "core/offset/summary.hpp"

#include "core/offset/expectations.hpp"
#include "core/offset/prepared.hpp"
#include "core/offset/rig_motion.hpp"

namespace sweepscope {

Result<RecordingSummary> summarise(const Recording& recording, const Job& job) {
  RecordingSummary summary = inspect(recording);
  const auto prepared = prepare(recording, FeatureOptions(), job);
  if (!prepared) return tl::unexpected(prepared.error());
  const MotionTest motion = test_motion(*prepared);
  if (motion.answered()) summary.motion = motion.moving() ? "moving" : "stationary";
  summary.expectations = expectations(recording, summary, prepared->motor);
  return summary;
}

}  // namespace sweepscope
