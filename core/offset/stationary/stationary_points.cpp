#include "core/offset/stationary/stationary_points.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

// Bins as wide as the spacing of the features, so that a bin holds at most one of a scan.
std::size_t beams_per_bin(const FeatureOptions& options) {
  return std::size_t(std::max(1, options.map_spacing));
}

// Which column of the grid a beam belongs to, before columns are put together to bins: its number, or, where
// scans do not all begin in the same direction, the number of increments from the first direction of all.
class Columns {
 public:
  explicit Columns(const Recording& recording) {
    if (recording.scans.empty() || !recording.directions.empty()) return;
    const LaserScan& first = recording.scans.front();
    const auto repeats = [&](const LaserScan& scan) {
      const double end_rad = scan.beam_angle_rad(first.beams) - first.beam_angle_rad(first.beams);
      return std::max(std::abs(scan.angle_min_rad - first.angle_min_rad), std::abs(end_rad)) <
             std::abs(first.angle_increment_rad) / 2;
    };
    if (std::ranges::all_of(recording.scans, repeats)) return;
    increment_rad_ = first.angle_increment_rad;
    first_rad_ = first.angle_min_rad;
    for (const LaserScan& scan : recording.scans)
      if ((scan.angle_min_rad - first_rad_) * increment_rad_ < 0) first_rad_ = scan.angle_min_rad;
  }
  double of(const LaserScan& scan, double beam) const {
    constexpr double kMost = 1e6;
    if (increment_rad_ == 0) return beam;
    return std::clamp((scan.beam_angle_rad(beam) - first_rad_) / increment_rad_, 0.0, kMost);
  }
  double beam_at(const LaserScan& scan, double column) const {
    if (increment_rad_ == 0) return column;
    return (first_rad_ + column * increment_rad_ - scan.angle_min_rad) / scan.angle_increment_rad;
  }

 private:
  double first_rad_ = 0, increment_rad_ = 0;  // 0: beams count
};

// Enough for the longest scan; but where a few scans are that much longer than the others that the grid would
// be empty mostly, their far ends are left out of it.
std::size_t bins_of(const std::vector<LaserScan>& scans, const Columns& columns, std::size_t beams_a_bin) {
  constexpr std::size_t kSparsest = 16;  // bounds the grid's memory by so many times that of its beams
  std::size_t most = 0, all = 0;
  for (const LaserScan& scan : scans) {
    most = std::max(most, std::size_t(columns.of(scan, scan.beams) + 0.5));
    all += scan.beams;
  }
  const std::size_t mean = all / std::max<std::size_t>(1, scans.size()) + 1;
  return std::min(most, kSparsest * mean) / beams_a_bin + 1;
}

// The whole turns of a motor that turns one way before a line, by its middle: lines of all turns then lie
// beside each other, and a line's cells keep their order.
double whole_turns_before(MotorReader& motor, const StationaryGrid& grid, std::size_t line, double offset_s) {
  constexpr double kTurn_rad = 2 * std::numbers::pi;
  const double middle_rad = motor.angle_at(grid.time_s[line * grid.bins + grid.bins / 2] + offset_s);
  return kTurn_rad * std::floor(middle_rad / kTurn_rad);
}

}  // namespace

StationaryGrid stationary_grid(const OffsetProblem& problem) {
  const auto& scans = problem.recording->scans;
  const FeatureList& planes = problem.features->planes;
  const FeatureOptions& options = problem.feature_options;
  StationaryGrid grid;
  grid.problem = &problem;
  const Columns columns(*problem.recording);
  grid.bins = bins_of(scans, columns, beams_per_bin(options));
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (problem.scan_used[i]) grid.scan.push_back(std::uint32_t(i));
  grid.feature.assign(grid.lines() * grid.bins, StationaryGrid::kNone);
  grid.time_s.resize(grid.lines() * grid.bins);
  grid.range_m.resize(grid.lines() * grid.bins);
  const double half = options.half_window;
  for (std::size_t line = 0; line < grid.lines(); ++line) {
    const std::size_t scan = grid.scan[line], first = line * grid.bins;
    for (std::size_t bin = 0; bin < grid.bins; ++bin)
      grid.time_s[first + bin] =
          scans[scan].beam_s(columns.beam_at(scans[scan], half + (double(bin) + 0.5) * options.map_spacing));
    for (std::size_t i = planes.scan_begin[scan]; i < planes.scan_begin[scan + 1]; ++i) {
      const Feature& feature = planes.features[i];
      const double column = std::round(columns.of(scans[scan], feature.beam));
      const std::size_t bin = std::size_t(std::max(0.0, column - half)) / beams_per_bin(options);
      if (bin >= grid.bins) continue;
      grid.feature[first + bin] = std::uint32_t(i);
      grid.time_s[first + bin] = feature.time_s;
      grid.range_m[first + bin] = feature.range_m;
    }
  }
  return grid;
}

StationaryPoints place_stationary(const StationaryGrid& grid, double offset_s, StationaryDetail detail) {
  const OffsetProblem& problem = *grid.problem;
  const Kinematics kinematics(problem.recording->rig.mount);
  MotorReader motor(problem.recording->motor);
  MotorSpeedReader speed(problem.recording->motor);
  const std::vector<std::size_t> sweep_of =
      assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s);
  StationaryPoints points;
  points.bins = grid.bins;
  points.offset_s = offset_s;
  points.sweep.assign(grid.lines(), kNoSweep);
  points.direction.assign(grid.lines(), 0);
  points.angle_rad.resize(grid.feature.size());
  points.placed.assign(grid.feature.size(), 0);
  if (detail == StationaryDetail::kPoints) {
    points.speed_rad_s.resize(grid.feature.size());
    points.p_m.resize(grid.feature.size());
  }
  const bool one_way = problem.motor.one_way();
  for (std::size_t line = 0; line < grid.lines(); ++line) {
    points.sweep[line] = sweep_of[grid.scan[line]];
    if (points.sweep[line] == kNoSweep) continue;
    const Sweep& sweep = problem.motor.sweeps[points.sweep[line]];
    points.direction[line] = sweep.side;
    const double whole_turns_rad = one_way ? whole_turns_before(motor, grid, line, offset_s) : 0;
    for (std::size_t cell = line * grid.bins; cell < (line + 1) * grid.bins; ++cell) {
      const double motor_s = grid.time_s[cell] + offset_s;
      points.angle_rad[cell] = motor.angle_at(motor_s) - whole_turns_rad;
      if (grid.feature[cell] == StationaryGrid::kNone) continue;
      if (motor_s < sweep.steady_begin_s || motor_s > sweep.steady_end_s) continue;
      points.placed[cell] = 1;
      if (detail == StationaryDetail::kAngles) continue;
      points.p_m[cell] = kinematics.base_from_motor(
          problem.features->planes.features[grid.feature[cell]].p_in_motor_m.cast<double>(),
          points.angle_rad[cell]);
      points.speed_rad_s[cell] = float(speed.speed_rad_s(motor_s));
    }
    points.pool[sweep.side > 0 ? 1 : 0].push_back(std::uint32_t(line));
  }
  const auto ring_of = [&](std::uint32_t scan) { return problem.recording->scans[scan].ring; };
  if (std::ranges::any_of(grid.scan,
                          [&](std::uint32_t scan) { return ring_of(scan) != ring_of(grid.scan[0]); }))
    for (const std::uint32_t scan : grid.scan) points.ring.push_back(ring_of(scan));
  const std::size_t middle = grid.bins / 2;
  for (LinePool& pool : points.pool)
    std::stable_sort(pool.begin(), pool.end(), [&](std::uint32_t a, std::uint32_t b) {
      if (points.ring_of(a) != points.ring_of(b)) return points.ring_of(a) < points.ring_of(b);
      return points.angle_rad[a * grid.bins + middle] < points.angle_rad[b * grid.bins + middle];
    });
  return points;
}

std::vector<LinePool> pools_by_sweep(const StationaryPoints& points) {
  std::vector<LinePool> pools;
  for (const LinePool& pool : points.pool) {
    for (const std::uint32_t line : pool) {
      if (points.sweep[line] >= pools.size()) pools.resize(points.sweep[line] + 1);
      pools[points.sweep[line]].push_back(line);
    }
  }
  return pools;
}

StationaryPatchOptions stationary_patch_options(const OffsetProblem& problem) {
  // A gap of 0.6 deg is seven steps of a usual encoder, 0.088 deg; within reach there is room for three lines
  // to a side.
  StationaryPatchOptions options;
  options.min_gap_rad = std::max(0.2 * problem.line_spacing_rad, 0.6 * kRadPerDeg);
  options.reach_rad = std::max(1.6 * problem.line_spacing_rad, 4 * options.min_gap_rad);
  options.thickness_m += problem.features->range_noise_m;
  return options;
}

StationaryNeighbours::StationaryNeighbours(const StationaryPoints& points, const LinePool& pool,
                                           std::size_t line, const StationaryPatchOptions& options)
    : points_(points),
      pool_(std::ranges::equal_range(pool, points.ring_of(std::uint32_t(line)), {},
                                     [&](std::uint32_t other) { return points.ring_of(other); })),
      options_(options) {}

void StationaryNeighbours::seek(double angle_rad, std::size_t bin) {
  while (next_ < pool_.size() && points_.angle_rad[cell(next_, bin)] < angle_rad) ++next_;
  while (next_ > 0 && points_.angle_rad[cell(next_ - 1, bin)] >= angle_rad) --next_;
}

StationaryNeighbours::Pair StationaryNeighbours::bracket(double angle_rad, std::size_t bin) {
  seek(angle_rad, bin);
  if (next_ == 0 || next_ == pool_.size()) return {};
  const Pair pair{true, cell(next_ - 1, bin), cell(next_, bin)};
  if (!points_.placed[pair.below] || !points_.placed[pair.above]) return {};
  if (points_.angle_rad[pair.above] - points_.angle_rad[pair.below] > options_.reach_rad) return {};
  return pair;
}

// Adds the points of the lines on one side of the angle.
StationaryNeighbours::Side StationaryNeighbours::collect(double angle_rad, std::size_t bin, int step) {
  const std::size_t first_bin = bin > 0 ? bin - 1 : bin, last_bin = std::min(bin + 1, points_.bins - 1);
  const int max_lines = std::min(options_.lines_per_side, kMaxLinesPerSide);
  Side side;
  double last_rad = 0;
  for (std::size_t place = step > 0 ? next_ : next_ - 1; place < pool_.size() && side.lines < max_lines;
       place += std::size_t(step)) {
    const double away_rad = step * (points_.angle_rad[cell(place, bin)] - angle_rad);
    if (away_rad > options_.reach_rad) break;
    if (side.lines > 0 && away_rad - last_rad < options_.min_gap_rad) continue;
    const int before = side.points;
    for (std::size_t c = cell(place, first_bin); c <= cell(place, last_bin); ++c) {
      if (!points_.placed[c]) continue;
      near_[count_++] = c;
      ++side.points;
      side.away_rad += std::abs(points_.angle_rad[c] - angle_rad);
    }
    if (side.points == before) continue;
    ++side.lines;
    last_rad = away_rad;
  }
  return side;
}

std::pair<StationaryNeighbours::Side, StationaryNeighbours::Side> StationaryNeighbours::collect_around(
    double angle_rad, std::size_t bin) {
  seek(angle_rad, bin);
  count_ = 0;
  const Side below = collect(angle_rad, bin, -1);
  return {below, collect(angle_rad, bin, 1)};
}

std::span<const std::size_t> StationaryNeighbours::around(double angle_rad, std::size_t bin) {
  collect_around(angle_rad, bin);
  return {near_.data(), count_};
}

StationaryPatch StationaryNeighbours::patch(double angle_rad, std::size_t bin, double range_m) {
  StationaryPatch patch;
  const auto [below, above] = collect_around(angle_rad, bin);
  if (below.lines == 0 || above.lines == 0 || below.lines + above.lines < 3 || count_ < 6) return patch;
  // The sides weigh so that the patch's centre comes to lie at the point's own motor angle: otherwise the
  // noise of the normal would enter both residual and lever and bias the offset.
  const double down_rad = below.away_rad / below.points, up_rad = above.away_rad / above.points;
  const double both_rad = std::max(1e-9, down_rad + up_rad);
  const double weight_below = up_rad / both_rad / below.points,
               weight_above = down_rad / both_rad / above.points;
  const Eigen::Vector3d origin = points_.p_m[near_[0]];
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count_; ++i) {
    const double weight = i < std::size_t(below.points) ? weight_below : weight_above;
    const Eigen::Vector3d d = points_.p_m[near_[i]] - origin;
    mean += weight * d;
    squares.noalias() += weight * d * d.transpose();
    patch.speed_rad_s += weight * points_.speed_rad_s[near_[i]];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(squares - mean * mean.transpose());
  const double thickness_m = std::max(options_.thickness_m, options_.thickness_slope * range_m);
  const double flat = solver.eigenvalues()[0], wide = solver.eigenvalues()[1];
  if (!(flat < thickness_m * thickness_m) || !(wide > 4 * flat)) return patch;
  patch.found = true;
  patch.centre_m = origin + mean;
  patch.normal = solver.eigenvectors().col(0);
  return patch;
}

}  // namespace sweepscope
