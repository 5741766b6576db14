#include "core/offset/direct_moving.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/offset/candidates.hpp"
#include "core/offset/moving.hpp"
#include "core/offset/uncertainty.hpp"

namespace sweepscope {
namespace {

// n and e at the roll's zero and to both sides of it.
std::vector<CurvePoint> sides(const OffsetProblem& problem, double offset_s,
                              const MovingDirectOptions& options, const Job& job) {
  const Job quiet = Job::part_of(job);
  std::vector<CurvePoint> curve(5);
  tbb::parallel_for(std::size_t{0}, curve.size(), [&](std::size_t i) {
    curve[i] = moving_candidate(problem, offset_s + (double(i) - 2) / 2 * options.side_s, Scoring::kTwoStage,
                                options.mapping, quiet);
  });
  return curve;
}

// Where the parabola through e about the roll's zero is least; that zero itself where e has no valley there.
double least_e_offset_s(const std::vector<CurvePoint>& curve, double zero_s, double side_s) {
  const std::size_t least = index_of_least(curve, &CurvePoint::e_m);
  if (least == 0 || least + 1 >= curve.size()) return zero_s;
  return fitted_extremum(curve, &CurvePoint::e_m, least, 2 * side_s).offset_s;
}

constexpr std::size_t kMostBlocks = 20;

// Of sweeps: long enough for what sways slowly, short enough to be several.
std::size_t block_length(std::size_t sweeps) {
  constexpr std::size_t kLength = 8, kLeastLength = 3, kBlocks = 6;
  return std::clamp(sweeps / kBlocks, kLeastLength, kLength);
}

void fill_blocks(const MovingPass& pass, double nominal_rad_s, MovingDirect& result) {
  const std::size_t sweeps = pass.sweep_s.size(),
                    blocks = std::min(kMostBlocks, sweeps / block_length(sweeps));
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t from = sweeps * b / blocks, to = sweeps * (b + 1) / blocks;
    double time_s = 0, roll_rad = 0;
    for (std::size_t k = from; k < to; ++k) {
      time_s += pass.sweep_s[k] / double(to - from);
      roll_rad += pass.sweep_roll_rad[k] / double(to - from);
    }
    result.block_s.push_back(time_s);
    result.block_offset_s.push_back(pass.offset_s - roll_rad / nominal_rad_s);
  }
}

}  // namespace

OffsetProblem beginning_of(const OffsetProblem& problem, double offset_s, std::size_t most_sweeps) {
  OffsetProblem part = problem;
  const std::vector<std::size_t> sweep_of = assign_sweeps(part.recording->scans, part.motor.sweeps, offset_s);
  for (std::size_t i = 0; i < part.scan_used.size(); ++i)
    if (sweep_of[i] != kNoSweep && sweep_of[i] >= most_sweeps) part.scan_used[i] = 0;
  return part;
}

std::optional<double> sigma_of_roll(const std::vector<double>& sweep_roll_rad) {
  return block_sigma(sweep_roll_rad, block_length(sweep_roll_rad.size()), kMostBlocks);
}

MovingPass moving_pass(const OffsetProblem& problem, double offset_s, const MappingOptions& options,
                       const Job& job) {
  MovingPass pass;
  pass.offset_s = offset_s;
  const Eigen::Vector3d axis = problem.recording->rig.mount.axis.normalized();
  const auto walk = track(place_sweeps(problem, offset_s), axis, options, job);
  if (!walk || walk->lost) return pass;
  AlternatingRoll roll = take_out_alternating_roll(walk->sweeps, axis, options.settling_sweeps);
  pass.tracked = !roll.sweep_s.empty();
  pass.roll_rad = roll.signed_rotation_rad;
  pass.sweep_s = std::move(roll.sweep_s);
  pass.sweep_roll_rad = std::move(roll.sweep_roll_rad);
  return pass;
}

MovingDirect solve_moving(const OffsetProblem& problem, double first_offset_s,
                          const MovingDirectOptions& options, const Job& job) {
  MovingDirect result;
  result.offset_s = first_offset_s;
  const double nominal_rad_s = 2 * problem.motor.median_speed_rad_s;
  for (int i = 0; i < options.most_passes && !result.converged; ++i) {
    result.passes.push_back(moving_pass(problem, result.offset_s, options.mapping, job));
    const MovingPass& pass = result.passes.back();
    result.lost = !pass.tracked;
    if (result.lost || job.cancelled()) return result;
    const double step_s = -pass.roll_rad / nominal_rad_s;
    result.offset_s += std::clamp(step_s, -options.most_step_s, options.most_step_s);
    result.converged = std::abs(step_s) < options.step_tolerance_s;
  }
  result.roll_offset_s = result.offset_s;
  result.curve = sides(problem, result.roll_offset_s, options, job);
  result.offset_s = least_e_offset_s(result.curve, result.roll_offset_s, options.side_s);
  const auto &below = result.curve.front().signed_rotation_rad,
             &above = result.curve.back().signed_rotation_rad;
  if (below && above) result.slope_of_nominal = (*above - *below) / (2 * options.side_s * nominal_rad_s);
  const MovingPass& last = result.passes.back();
  if (const auto sigma_rad = sigma_of_roll(last.sweep_roll_rad)) result.sigma_s = *sigma_rad / nominal_rad_s;
  fill_blocks(last, nominal_rad_s, result);
  return result;
}

}  // namespace sweepscope
