#pragma once

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/offset/estimate.hpp"
#include "core/offset/estimate_options.hpp"
#include "core/offset/kept_candidates.hpp"
#include "core/offset/prepared.hpp"
#include "core/offset/sampled_sweeps.hpp"

namespace sweepscope {

/// What a rig is taken for before the motion test.
inline constexpr RigKind kUnknownKind = RigKind::kStationary;

/// The recording that a prepared one is a sample of.
struct Sampled {
  const Recording& whole;
  const SampledSweeps* sweeps;  // null: the sample is the whole
  bool parts_only = false;      // `whole` holds only what a stationary rig's answer goes by
};

/// The main path, from a recording to its offset: coarse search, motion test, method, answer. For the errors
/// see `estimate`. Unfinished where the job is cancelled, and where the rig moved and a sample is not enough.
Result<Estimate> find_offset(const PreparedRecording& prepared, const EstimateOptions& options,
                             const KeptCandidates& kept, const Job& job, const Sampled* sampled = nullptr);

}  // namespace sweepscope
