#pragma once

// The mathematics: docs/algorithms.md, section 9.

#include <string>
#include <vector>

#include "core/offset/estimate_options.hpp"
#include "core/offset/rig_motion.hpp"

namespace sweepscope {

/// What the rig is taken for, and why.
struct KindDecision {
  RigKind kind = RigKind::kStationary;
  std::string reason;  // a sentence
  std::vector<std::string> warnings;
};

/// What the options assume, else what the motion test found.
KindDecision decide_kind(const MotionTest& test, const EstimateOptions& options);

/// Why a rig is taken to have moved: a sentence.
std::string moved_text(const MotionTest& test);
/// How many pairs of sweeps lie apart, and by how much: a sentence.
std::string pairs_text(const MotionTest& test);

}  // namespace sweepscope
