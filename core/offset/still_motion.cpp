#include "core/offset/still_motion.hpp"

#include <algorithm>

#include "core/loam/least_squares.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMostPairs = 16;
constexpr std::size_t kLeastMatches = 60;
constexpr double kStillTranslation_m = 0.04;  // what noise of 30 mm leaves of a rig that stands still is less
constexpr double kStillRotation_rad = 0.02;

struct PointOnPlane {
  Eigen::Vector3d p_m;
  StillPatch patch;
};

Pose registered(const std::vector<PointOnPlane>& matches) {
  constexpr double kLeastEigenvalue = 0.015;  // per match: below, the scene does not tell
  Pose pose;
  double loss_width_m = 0.5;
  for (int iteration = 0; iteration < 12; ++iteration) {
    Matrix6d a = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    for (const auto& [p_m, patch] : matches) {
      const Eigen::Vector3d moved_m = pose * p_m;
      const double distance_m = patch.normal.dot(moved_m - patch.centre_m);
      const double weight = cauchy_weight(distance_m, loss_width_m);
      const Vector6d row = distance_jacobian(moved_m, patch.normal, Eigen::Vector3d::Zero());
      a.noalias() += weight * row * row.transpose();
      g += weight * distance_m * row;
    }
    int free_directions = 0;
    const Vector6d step = solve_determined(a, g, kLeastEigenvalue * double(matches.size()), free_directions);
    pose = stepped(pose, step, Eigen::Vector3d::Zero());
    loss_width_m = std::max(0.05, 0.6 * loss_width_m);
    if (loss_width_m == 0.05 && step.cwiseAbs().maxCoeff() < 1e-5) break;
  }
  return pose;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// The sweep of each of the grid's lines; kNoSweep where none.
std::vector<std::size_t> sweep_of_lines(const StillGrid& grid, double offset_s) {
  const auto sweep_of_scan =
      assign_sweeps(grid.problem->recording->scans, grid.problem->motor.sweeps, offset_s);
  std::vector<std::size_t> sweep_of;
  for (const std::uint32_t scan : grid.scan) sweep_of.push_back(sweep_of_scan[scan]);
  return sweep_of;
}

// The grid's lines of these sweeps (ascending) alone: the points of all would take more memory than the
// recording.
StillGrid lines_of(const StillGrid& grid, const std::vector<std::size_t>& sweep_of,
                   const std::vector<std::size_t>& sweeps) {
  StillGrid part;
  part.problem = grid.problem;
  part.bins = grid.bins;
  const auto append = [&](const auto& from, std::size_t line, auto& to) {
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(line * grid.bins);
    to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(grid.bins));
  };
  for (std::size_t line = 0; line < grid.lines(); ++line) {
    if (!std::binary_search(sweeps.begin(), sweeps.end(), sweep_of[line])) continue;
    part.scan.push_back(grid.scan[line]);
    append(grid.feature, line, part.feature);
    append(grid.time_s, line, part.time_s);
    append(grid.range_m, line, part.range_m);
  }
  return part;
}

std::vector<std::size_t> whole_sweeps(const StillGrid& grid, const std::vector<std::size_t>& sweep_of) {
  std::vector<std::size_t> lines;
  for (const std::size_t sweep : sweep_of) {
    if (sweep == kNoSweep) continue;
    if (sweep >= lines.size()) lines.resize(sweep + 1);
    ++lines[sweep];
  }
  const std::size_t most = lines.empty() ? 0 : *std::max_element(lines.begin(), lines.end());
  std::vector<std::size_t> whole;
  for (std::size_t sweep = 0; sweep < lines.size(); ++sweep) {
    const Sweep& motor = grid.problem->motor.sweeps[sweep];
    const bool full_turn = motor.end_s - motor.begin_s > 0.7 * grid.problem->motor.median_sweep_s;
    if (full_turn && 10 * lines[sweep] > 7 * most) whole.push_back(sweep);
  }
  return whole;
}

}  // namespace

std::optional<SweepShift> shift_between(const StillPoints& points, const LinePool& target,
                                        const LinePool& source, const StillGrid& grid) {
  StillPatchOptions patches = still_patch_options(*grid.problem);
  patches.thickness_m *= 2;
  std::vector<PointOnPlane> matches;
  SweepShift shift;
  for (const std::uint32_t line : source) {
    StillNeighbours neighbours(points, target, line, patches);
    for (std::size_t bin = 0; bin < points.bins; ++bin) {
      const std::size_t cell = line * points.bins + bin;
      if (!points.placed[cell]) continue;
      ++shift.features;
      const StillPatch patch = neighbours.patch(points.angle_rad[cell], bin, grid.range_m[cell]);
      if (patch.found) matches.push_back({points.p_m[cell], patch});
    }
  }
  shift.matches = matches.size();
  if (matches.size() < kLeastMatches) return std::nullopt;
  const Pose pose = registered(matches);
  shift.translation_m = pose.translation_m.norm();
  const Eigen::Vector3d rotation_rad = vector_from_rotation(pose.rotation);
  const Eigen::Vector3d axis = grid.problem->recording->rig.mount.axis.normalized();
  shift.rotation_rad = rotation_rad.norm();
  shift.tilt_rad = (rotation_rad - axis.dot(rotation_rad) * axis).norm();
  return shift;
}

MotionTest test_motion(const StillGrid& grid, double offset_s) {
  const std::vector<std::size_t> sweep_of = sweep_of_lines(grid, offset_s);
  const std::vector<std::size_t> whole = whole_sweeps(grid, sweep_of);
  std::vector<std::size_t> firsts, chosen, needed;
  for (const std::size_t sweep : whole)
    if (std::binary_search(whole.begin(), whole.end(), sweep + 2)) firsts.push_back(sweep);
  const std::size_t stride = std::max<std::size_t>(1, firsts.size() / kMostPairs);
  for (std::size_t i = 0; i < firsts.size(); i += stride) {
    chosen.push_back(firsts[i]);
    needed.insert(needed.end(), {firsts[i], firsts[i] + 2});
  }
  std::sort(needed.begin(), needed.end());
  const StillGrid part = lines_of(grid, sweep_of, needed);
  const StillPoints points = place_still(part, offset_s, StillDetail::kPoints);
  const std::vector<LinePool> pools = pools_by_sweep(points);
  MotionTest test;
  std::vector<double> translations_m, rotations_rad;
  for (const std::size_t first : chosen) {
    const auto shift = shift_between(points, pools[first], pools[first + 2], part);
    if (!shift) continue;  // too little to see for either answer
    ++test.pairs;
    if (shift->translation_m > kStillTranslation_m || shift->rotation_rad > kStillRotation_rad) ++test.moved;
    translations_m.push_back(shift->translation_m);
    rotations_rad.push_back(shift->rotation_rad);
  }
  test.median_translation_m = median(translations_m);
  test.median_rotation_rad = median(rotations_rad);
  return test;
}

std::optional<SweepShift> shift_from_first_to_last(const StillGrid& grid, double offset_s) {
  const std::vector<std::size_t> sweep_of = sweep_of_lines(grid, offset_s);
  const std::vector<std::size_t> whole = whole_sweeps(grid, sweep_of);
  for (std::size_t back = whole.size(); back-- > 1;) {
    if ((whole[back] - whole.front()) % 2 != 0) continue;
    const StillGrid part = lines_of(grid, sweep_of, {whole.front(), whole[back]});
    const StillPoints points = place_still(part, offset_s, StillDetail::kPoints);
    const std::vector<LinePool> pools = pools_by_sweep(points);
    return shift_between(points, pools[whole.front()], pools[whole[back]], part);
  }
  return std::nullopt;
}

}  // namespace sweepscope
