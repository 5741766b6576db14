#pragma once

#include <memory>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/sweep_features.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// What is computed from a recording once, for all later work: nothing in it depends on the offset. Motion
/// test, estimates, maps, report and calibration share it. Copies share the features.
struct PreparedRecording {
  std::shared_ptr<const Recording> recording;  // what it was computed from
  FeatureOptions feature_options{};            // that the features were computed with
  std::shared_ptr<const FeatureSet> features;  // of all scans
  MotorMotion motor;                           // sweeps, speed and period
  double line_spacing_rad = 0;                 // by which the motor turns from one scan to the next
};

/// Fails only where the job is cancelled (ExitCode::kInterrupted).
Result<PreparedRecording> prepare(std::shared_ptr<const Recording> recording, const FeatureOptions& options,
                                  const Job& job);
/// The same of a recording that outlives the result.
Result<PreparedRecording> prepare(const Recording& recording, const FeatureOptions& options, const Job& job);

/// A pointer to a recording that somebody else owns and that outlives it.
std::shared_ptr<const Recording> borrowed(const Recording& recording);

/// Per scan 1 where the motor track covers it, without a gap, at every offset from `min_s` to `max_s`: all
/// candidates must use the same scans, or the criteria count scans instead of sharpness.
std::vector<char> scans_covered(const Recording& recording, double min_s, double max_s);

/// The recording with the scans that can be used at every offset from `min_s` to `max_s`.
OffsetProblem problem_for(const PreparedRecording& prepared, double min_s, double max_s);

/// The problem cut down to its first sweeps.
OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t max_sweeps);

/// The first `max_sweeps` sweeps of each side: of a motor that turns one way the other side may come late.
OffsetProblem beginnings_of_sides(const OffsetProblem& problem, double offset_s, std::size_t max_sweeps);

}  // namespace sweepscope
