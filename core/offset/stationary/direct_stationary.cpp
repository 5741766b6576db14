#include "core/offset/stationary/direct_stationary.hpp"

#include <algorithm>
#include <cmath>

#include "core/numbers.hpp"
#include "core/offset/stationary/line_residuals.hpp"
#include "core/offset/stationary/stationary_evidence.hpp"

namespace sweepscope {
namespace {

double robust_deviation_m(const std::vector<LineResiduals>& lines) {
  std::vector<float> sizes_m;
  for (const LineResiduals& line : lines)
    for (const PatchDistance& residual : line.residuals)
      sizes_m.push_back(float(std::abs(residual.distance_m)));
  return kSigmaPerMedianDeviation * double(median(std::move(sizes_m)));
}

}  // namespace

StationaryDirect solve_stationary(const StationaryGrid& grid, double first_offset_s,
                                  const StationaryDirectOptions& options, const Job& job) {
  const StationaryPatchOptions patches = stationary_patch_options(*grid.problem);
  StationaryDirect result;
  result.offset_s = first_offset_s;
  double loss_width_m = options.first_loss_width_m;
  bool narrowed = false;
  double damping =
      1;  // where matches come and go, steps go to and fro about a jump of the gradient: halve it
  for (; result.iterations < options.max_iterations && !job.cancelled(); ++result.iterations) {
    const StationaryLinearisation at(grid, patches, result.offset_s);
    const std::vector<LineResiduals> lines = at.residuals();
    const OffsetEquation sums = offset_equation(lines, loss_width_m);
    result.features = sums.features;
    result.matches = sums.matches;
    if (sums.matches < options.min_matches || !(sums.jj > 0)) return result;
    const double step_s = sums.step_s();
    if (result.iterations >= options.undamped_iterations && step_s * result.step_s < 0) damping /= 2;
    result.step_s = step_s;
    result.residual_m = robust_deviation_m(lines);
    result.converged = narrowed && std::abs(damping * step_s) < options.step_tolerance_s;
    const bool last = result.converged || result.iterations + 1 == options.max_iterations;
    result.offset_s += damping * step_s;
    if (last) {
      fill_scan_time(at.points(), lines, loss_width_m, result);
      if (options.resampling != Resampling::kNone)
        resample(grid, at, lines, loss_width_m, options.resampling, result);
      break;
    }
    const double width_m = std::max(options.min_loss_width_m, options.loss_widths * result.residual_m);
    narrowed = width_m > 0.7 * loss_width_m;
    loss_width_m = std::min(width_m, loss_width_m);
  }
  return result;
}

}  // namespace sweepscope
