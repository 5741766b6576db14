#pragma once

// The mathematics: docs/algorithms.md, section 9.

#include <string>
#include <vector>

#include "core/offset/kind/rig_motion.hpp"
#include "core/offset/prepared/options.hpp"

namespace sweepscope {

/// The kind that the rig is treated as, and why.
struct KindDecision {
  RigKind kind = RigKind::kStationary;
  std::string reason;  // a sentence
  std::vector<std::string> warnings;
};

/// The kind that the options assume; otherwise the result of the motion test.
KindDecision decide_kind(const MotionTest& test, const EstimateOptions& options);

/// Why a rig is treated as moving: a sentence.
std::string moved_text(const MotionTest& test);
/// How many pairs of sweeps differ, and by how much: a sentence.
std::string pairs_text(const MotionTest& test);

}  // namespace sweepscope
