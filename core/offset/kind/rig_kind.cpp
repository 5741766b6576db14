#include "core/offset/kind/rig_kind.hpp"

#include <fmt/format.h>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

bool only_within_sweeps(const MotionTest& test) {
  return test.within_sweeps && !test.pairs_differ() && !test.moved_slowly() && !test.neighbours_differ();
}

}  // namespace

std::string moved_text(const MotionTest& test) {
  if (!test.pairs_differ() && test.moved_slowly())
    return "The rig moved: its last sweeps do not match its first ones.";
  if (!test.pairs_differ() && test.neighbours_differ())
    return fmt::format("The rig moved: in {} of {} pairs, neighbouring sweeps do not match at any offset.",
                       test.neighbours_moved, test.neighbours);
  if (only_within_sweeps(test))
    return "The rig moved during a part of a sweep: scan lines there do not match the sweeps next to them.";
  return fmt::format("The rig moved: in {} of {} pairs, sweeps of the same direction do not match.",
                     test.moved, test.pairs);
}

std::string pairs_text(const MotionTest& test) {
  if (only_within_sweeps(test))
    return "Scan lines of a part of a sweep do not match the sweeps next to them.";
  if (test.pairs == 0 || (!test.pairs_differ() && test.neighbours_differ()))
    return fmt::format("{} of {} pairs of neighbouring sweeps differ at every offset.", test.neighbours_moved,
                       test.neighbours);
  return fmt::format("{} of {} pairs of sweeps of the same direction differ; median {:.3f} m and {:.2f} deg.",
                     test.moved, test.pairs, test.median_translation_m,
                     test.median_rotation_rad * kDegPerRad);
}

KindDecision decide_kind(const MotionTest& test, const EstimateOptions& options) {
  KindDecision decision;
  if (options.assume) {
    decision.kind = *options.assume;
    decision.reason = "As assumed.";
    if (decision.kind == RigKind::kStationary && test.moving())
      decision.warnings.push_back(moved_text(test) + " It is treated as stationary, as assumed.");
  } else if (test.answered()) {
    decision.kind = test.moving() ? RigKind::kMoving : RigKind::kStationary;
    decision.reason = pairs_text(test);
  } else {
    decision.reason = "Too few sweeps match to decide whether the rig moved: it is treated as stationary.";
    if (options.method != Method::kMoving) decision.warnings.push_back(decision.reason);
  }
  return decision;
}

}  // namespace sweepscope
