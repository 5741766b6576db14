#include "core/offset/prepared/prepared.hpp"

#include <algorithm>

#include "core/numbers.hpp"

namespace sweepscope {

Result<PreparedRecording> prepare(std::shared_ptr<const Recording> recording, const FeatureOptions& options,
                                  const Job& job) {
  auto features = extract_features(*recording, options, job);
  if (!features) return tl::unexpected(features.error());
  PreparedRecording prepared;
  prepared.feature_options = options;
  prepared.features = std::make_shared<const FeatureSet>(std::move(*features));
  prepared.motor = find_sweeps(*recording);
  prepared.line_spacing_rad = line_spacing_rad(*recording, prepared.motor);
  prepared.recording = std::move(recording);
  return prepared;
}

Result<PreparedRecording> prepare(const Recording& recording, const FeatureOptions& options, const Job& job) {
  return prepare(borrowed(recording), options, job);
}

std::shared_ptr<const Recording> borrowed(const Recording& recording) {
  return {std::shared_ptr<const Recording>(), &recording};
}

std::vector<char> scans_covered(const Recording& recording, double min_s, double max_s) {
  const double max_gap_s = std::max(0.05, 5 * median(spacings(recording.motor.time_s)));
  std::vector<char> covered(recording.scans.size(), 0);
  for (std::size_t i = 0; i < recording.scans.size(); ++i)
    covered[i] = recording.motor.covers(recording.scans[i].first_beam_s + min_s,
                                        recording.scans[i].last_beam_s() + max_s, max_gap_s);
  return covered;
}

OffsetProblem problem_for(const PreparedRecording& prepared, double min_s, double max_s) {
  OffsetProblem problem;
  problem.recording = prepared.recording.get();
  problem.feature_options = prepared.feature_options;
  problem.features = prepared.features;
  problem.motor = prepared.motor;
  problem.scan_used = scans_covered(*prepared.recording, min_s, max_s);
  problem.line_spacing_rad = prepared.line_spacing_rad;
  return problem;
}

OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t max_sweeps) {
  OffsetProblem part = problem;
  const std::vector<std::size_t> sweep_of = assign_sweeps(part.recording->scans, part.motor.sweeps, offset_s);
  for (std::size_t i = 0; i < part.scan_used.size(); ++i)
    if (sweep_of[i] != kNoSweep && sweep_of[i] >= max_sweeps) part.scan_used[i] = 0;
  return part;
}

OffsetProblem beginnings_of_sides(const OffsetProblem& problem, double offset_s, std::size_t max_sweeps) {
  OffsetProblem part = problem;
  const std::vector<Sweep>& sweeps = part.motor.sweeps;
  std::size_t of_side[2] = {0, 0};
  std::vector<char> kept;
  for (const Sweep& sweep : sweeps) kept.push_back(of_side[sweep.side > 0]++ < max_sweeps);
  const std::vector<std::size_t> sweep_of = assign_sweeps(part.recording->scans, sweeps, offset_s);
  for (std::size_t i = 0; i < part.scan_used.size(); ++i)
    if (sweep_of[i] != kNoSweep && !kept[sweep_of[i]]) part.scan_used[i] = 0;
  return part;
}

}  // namespace sweepscope
