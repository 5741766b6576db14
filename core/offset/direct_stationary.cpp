#include "core/offset/direct_stationary.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace sweepscope {
namespace {

constexpr double kCoarseCap_m = 0.3;

// The lines of each sweep, in the order of the motor's angle.
std::vector<LinePool> pools_by_sweep(const StillPoints& points) {
  std::vector<LinePool> pools;
  for (const LinePool& pool : points.pool) {
    for (const std::uint32_t line : pool) {
      if (points.sweep[line] >= pools.size()) pools.resize(points.sweep[line] + 1);
      pools[points.sweep[line]].push_back(line);
    }
  }
  return pools;
}

struct CoarseSum {
  double sum_m = 0;
  std::size_t count = 0, asked = 0;
};

// Differences between a line's ranges and another sweep's at the same motor angle and beam. On a plane
// 1 / r goes as A cos(angle) + B sin(angle), which two lines tell.
void add_differences(const StillGrid& grid, const StillPoints& points, std::size_t line, const LinePool& pool,
                     const StillPatchOptions& patches, CoarseSum& total) {
  StillNeighbours neighbours(points, pool, patches);
  for (std::size_t bin = line % 2; bin < points.bins; bin += 2) {
    const std::size_t cell = line * points.bins + bin;
    if (!points.placed[cell]) continue;
    ++total.asked;
    const double angle_rad = points.angle_rad[cell];
    const auto [found, below, above] = neighbours.bracket(angle_rad, bin);
    if (!found) continue;
    const double up = angle_rad - points.angle_rad[below], down = points.angle_rad[above] - angle_rad;
    const double inverse_range = (std::sin(down) / grid.range_m[below] + std::sin(up) / grid.range_m[above]) /
                                 std::max(1e-9, std::sin(up + down));
    total.sum_m += std::min(std::abs(grid.range_m[cell] - 1 / inverse_range), kCoarseCap_m);
    ++total.count;
  }
}

std::optional<double> coarse_cost_m(const StillGrid& grid, const StillPatchOptions& patches, double offset_s) {
  const StillPoints points = place_still(grid, offset_s, StillDetail::kAngles);
  const std::vector<LinePool> pools = pools_by_sweep(points);
  CoarseSum total;
  for (std::size_t line = 0; line < points.lines(); ++line) {
    const std::size_t sweep = points.sweep[line];
    if (sweep == kNoSweep) continue;
    if (sweep > 0) add_differences(grid, points, line, pools[sweep - 1], patches, total);
    if (sweep + 1 < pools.size()) add_differences(grid, points, line, pools[sweep + 1], patches, total);
  }
  if (total.count < 100 || 5 * total.count < total.asked) return std::nullopt;
  return total.sum_m / double(total.count);
}

struct Residual {
  double jacobian_m_s = 0, distance_m = 0;
};

// One line's points against the other direction's patches.
struct LineResiduals {
  std::vector<Residual> residuals;
  std::size_t features = 0;
};

class Linearisation {
 public:
  Linearisation(const StillGrid& grid, const StillPatchOptions& patches, double offset_s)
      : grid_(grid), patches_(patches), points_(place_still(grid, offset_s, StillDetail::kPoints)) {}

  const StillPoints& points() const { return points_; }

  // All lines against the pools.
  std::vector<LineResiduals> residuals(const std::array<LinePool, 2>& pools,
                                       const std::vector<char>& left_out) const {
    const Eigen::Vector3d axis = grid_.problem->recording->rig.mount.axis.normalized();
    std::vector<LineResiduals> found(points_.lines());
    tbb::parallel_for(std::size_t{0}, points_.lines(), [&](std::size_t line) {
      if (points_.sweep[line] == kNoSweep || (!left_out.empty() && left_out[line])) return;
      StillNeighbours neighbours(points_, pools[points_.direction[line] > 0 ? 0 : 1], patches_);
      LineResiduals& of_line = found[line];
      for (std::size_t bin = 0; bin < points_.bins; ++bin) {
        const std::size_t cell = line * points_.bins + bin;
        if (!points_.placed[cell]) continue;
        ++of_line.features;
        const StillPatch patch = neighbours.patch(points_.angle_rad[cell], bin, grid_.range_m[cell]);
        if (!patch.found) continue;
        const Eigen::Vector3d& p_m = points_.p_m[cell];
        of_line.residuals.push_back(
            {(points_.speed_rad_s[cell] - patch.speed_rad_s) * patch.normal.dot(axis.cross(p_m)),
             patch.normal.dot(p_m - patch.centre_m)});
      }
    });
    return found;
  }

 private:
  const StillGrid& grid_;
  const StillPatchOptions& patches_;
  StillPoints points_;
};

double robust_deviation_m(const std::vector<LineResiduals>& lines) {
  std::vector<float> sizes_m;
  for (const LineResiduals& line : lines)
    for (const Residual& residual : line.residuals) sizes_m.push_back(float(std::abs(residual.distance_m)));
  if (sizes_m.empty()) return 0;
  const auto middle = sizes_m.begin() + std::ptrdiff_t(sizes_m.size() / 2);
  std::nth_element(sizes_m.begin(), middle, sizes_m.end());
  return 1.4826 * double(*middle);
}

StationarySums summed(const std::vector<LineResiduals>& lines, double loss_width_m) {
  StationarySums sums;
  for (const LineResiduals& line : lines) {
    sums.features += line.features;
    sums.matches += line.residuals.size();
    for (const auto& [jacobian_m_s, distance_m] : line.residuals) {
      const double ratio = distance_m / loss_width_m, weight = 1 / (1 + ratio * ratio);
      sums.jj += weight * jacobian_m_s * jacobian_m_s;
      sums.jr += weight * jacobian_m_s * distance_m;
    }
  }
  return sums;
}

}  // namespace

std::vector<CurvePoint> stationary_coarse_curve(const StillGrid& grid, const std::vector<double>& offsets_s,
                                                const Job& job) {
  const StillPatchOptions patches = still_patch_options(*grid.problem);
  std::vector<CurvePoint> curve(offsets_s.size());
  tbb::parallel_for(std::size_t{0}, offsets_s.size(), [&](std::size_t i) {
    curve[i].offset_s = offsets_s[i];
    if (!job.cancelled()) curve[i].d = coarse_cost_m(grid, patches, offsets_s[i]);
  });
  return curve;
}

StationaryDirect solve_stationary(const StillGrid& grid, double first_offset_s,
                                  const StationaryDirectOptions& options, const Job& job) {
  const StillPatchOptions patches = still_patch_options(*grid.problem);
  StationaryDirect result;
  result.offset_s = first_offset_s;
  double loss_width_m = options.first_loss_width_m;
  for (; result.iterations < options.most_iterations && !job.cancelled(); ++result.iterations) {
    const Linearisation at(grid, patches, result.offset_s);
    const auto residuals = at.residuals(at.points().pool, {});
    const StationarySums sums = summed(residuals, loss_width_m);
    result.features = sums.features;
    result.matches = sums.matches;
    if (sums.matches < 100 || !(sums.jj > 0)) return result;
    const double step_s = -sums.jr / sums.jj;
    result.offset_s += step_s;
    result.residual_m = robust_deviation_m(residuals);
    loss_width_m = std::max(options.least_loss_width_m, options.loss_widths * result.residual_m);
    result.converged = std::abs(step_s) < options.step_tolerance_s;
    if (result.converged) break;
  }
  return result;
}

}  // namespace sweepscope
