#pragma once

// The mathematics: docs/algorithms.md, sections 13.6 and 14.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/offset/judgement/identifiability.hpp"

namespace sweepscope {

/// A step between two levels of a series, in which at most one value lies on neither.
struct OffsetStep {
  double begin_s = 0, end_s = 0;     // of the interval in which it lies
  double before_s = 0, after_s = 0;  // the two levels
  double squares_s2 = 0;             // of what is left
  double size_s() const { return after_s - before_s; }
};
/// The step that leaves the least; absent for fewer than two values.
std::optional<OffsetStep> best_step(const std::vector<double>& times_s, const std::vector<double>& offsets_s);

/// A part of a recording against the course of the whole.
struct PartOffset {
  double time_s = 0;  // since the first scan
  double offset_s = 0, expected_s = 0;
  double sigma_s = 0;  // 0: not known
};

/// What an answer shows about itself, of a stationary rig, a walk or an offset over time.
struct OffsetEvidence {
  bool converged = true;
  double last_step_s = 0;  // 0: below the tolerance
  /// The matches of a walk change between its iterations, so that steps of less than sigma are usual.
  bool steps_may_alternate = false;
  double residual_m = 0, range_noise_m = 0;  // 0: not compared
  /// By how much an offset of 1 s moves the points, rms: what turns a distance into an offset.
  double lever_m_s = 0;
  /// Offsets of parts of the recording; a constant one is expected where none of them has a sigma.
  std::vector<PartOffset> parts;
  std::optional<Trend> trend;  // of the parts
  double duration_s = 0;
  double min_window_s = 0;  // the shortest window of an offset over time
};

/// What follows for the answer: a wider sigma, with what it is widened by and why, or that it is refused.
struct Verdict {
  std::optional<double> sigma_s;
  std::vector<std::pair<std::string, double>> widened;  // see Answer::sigma_parts
  std::vector<std::string> warnings;
  Refusals refusals;
};

/// Judges an answer whose offset should be constant.
Verdict judge_constant(const OffsetEvidence& evidence, std::optional<double> sigma_s);
/// Judges a course by the windows: `parts` have what it expects of each.
Verdict judge_course(const OffsetEvidence& evidence, double sigma_s);
/// The windows lie off their course by more than chance.
bool is_off_course(const PartOffset& part);

/// What to do about an offset that changes: search over time where that answers, otherwise the way to a
/// recording or a part of it that has an answer. `jump_s`: when it jumps; none: it drifts.
std::string advice_on_change(const OffsetEvidence& evidence, std::optional<double> jump_s);

/// The sweeps of the shortest window of an offset over time: fewer have no scatter.
inline constexpr std::size_t kMinSweepsOfWindow = 6;

}  // namespace sweepscope
