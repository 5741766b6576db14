#pragma once

// The mathematics: docs/algorithms.md, section 10.

#include <vector>

#include "core/loam/mapping.hpp"
#include "core/loam/path/agreement.hpp"

namespace sweepscope {

/// A tracked walk, and what the tracks that it was chosen from say of each other.
struct JudgedWalk : TrackedWalk {
  std::vector<char> agreed;  // of each sweep of the first stretch whether another track confirms it
  std::vector<Contradiction> contradictions;
};

/// As `track`. Where the best of the tracks is alone with its motion, that of the others is taken (see
/// `mended`). `earlier` is the walk as it was tracked at a near offset, to compare with; null: none.
Result<JudgedWalk> track_and_judge(const OffsetProblem& problem, double offset_s,
                                   const MappingOptions& options, const JudgedWalk* earlier, const Job& job);

/// Sweeps in a row whose poses are known, of all sweeps from the `first` one.
struct KnownSweeps {
  std::size_t first = 0;
  std::vector<SweepPose> poses;
};

/// As `track`, but on the map of the known sweeps, and from there alone.
Result<JudgedWalk> track_from(const OffsetProblem& problem, double offset_s, KnownSweeps known,
                              const MappingOptions& options, const Job& job);

}  // namespace sweepscope
