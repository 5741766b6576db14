#include "core/offset/kind/sweep_shift.hpp"

#include <algorithm>
#include <cmath>

#include "core/loam/path/least_squares.hpp"

namespace sweepscope {
namespace {

constexpr std::size_t kMinMatches = 120;  // of both sweeps together: twenty for each unknown

struct PointOnPlane {
  Eigen::Vector3d p_m;
  StationaryPatch patch;
};

double distance_m(const PointOnPlane& match, const Pose& pose) {
  return match.patch.normal.dot(pose * match.p_m - match.patch.centre_m);
}

// The points of `source` on the patches of `target`.
std::vector<PointOnPlane> matched(const StationaryPoints& points, const LinePool& target,
                                  const LinePool& source, const StationaryGrid& grid, SweepShift& shift) {
  StationaryPatchOptions patches = stationary_patch_options(*grid.problem);
  patches.thickness_m *= 2;
  std::vector<PointOnPlane> matches;
  for (const std::uint32_t line : source) {
    StationaryNeighbours neighbours(points, target, line, patches);
    for (std::size_t bin = 0; bin < points.bins; ++bin) {
      const std::size_t cell = line * points.bins + bin;
      if (!points.placed[cell]) continue;
      ++shift.features;
      const StationaryPatch patch = neighbours.patch(points.angle_rad[cell], bin, grid.range_m[cell]);
      if (patch.found) matches.push_back({points.p_m[cell], patch});
    }
  }
  shift.matches += matches.size();
  return matches;
}

// Both sweeps' points on the other's patches. A patch across a bent surface lies beside it, to the same side
// whichever sweep it is of: a shift would take the one sweep's points onto their patches only by taking the
// other's off theirs.
std::vector<PointOnPlane> matched_both_ways(const StationaryPoints& points, const LinePool& target,
                                            const LinePool& source, const StationaryGrid& grid,
                                            SweepShift& shift) {
  std::vector<PointOnPlane> matches = matched(points, target, source, grid, shift);
  for (PointOnPlane& match : matched(points, source, target, grid, shift)) {
    std::swap(match.p_m, match.patch.centre_m);  // it is the patch that moves with the source
    matches.push_back(match);
  }
  return matches;
}

// Gauss-Newton under a Cauchy loss that narrows down to `width_m`: a wider loss at the beginning finds poses
// that are farther off, and is biased more by things that move.
struct Registering {
  double first_width_m = 0, width_m = 0;
  double min_eigenvalue = 0;  // of the normal matrix, per match: below, the scene does not determine it
};

Pose registered(const std::vector<PointOnPlane>& matches, Pose pose, const Registering& options) {
  constexpr int kMaxIterations = 20;  // more than the loss takes to narrow down
  double width_m = options.first_width_m;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    RigidEquations equations;
    for (const PointOnPlane& match : matches) {
      const double d_m = distance_m(match, pose);
      equations.add(pose * match.p_m, match.patch.normal, d_m, cauchy_weight(d_m, width_m));
    }
    int free_directions = 0;
    const Vector6d step = solve_determined(equations.matrix, equations.gradient,
                                           options.min_eigenvalue * double(matches.size()), free_directions);
    pose = stepped(pose, step, Eigen::Vector3d::Zero());
    if (width_m <= options.width_m && step.cwiseAbs().maxCoeff() < 1e-5) break;
    width_m = std::max(options.width_m, 0.6 * width_m);
  }
  return pose;
}

// The same with a rotation about the motor's axis as the one unknown.
Pose at_rest(const std::vector<PointOnPlane>& matches, const Eigen::Vector3d& axis, double width_m) {
  constexpr int kMaxIterations = 20;  // more than the loss takes to narrow down
  Pose pose;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    double a = 0, g = 0;
    for (const PointOnPlane& match : matches) {
      const double d_m = distance_m(match, pose), weight = cauchy_weight(d_m, width_m);
      const double lever_m = match.patch.normal.dot(axis.cross(pose * match.p_m));
      a += weight * lever_m * lever_m;
      g += weight * lever_m * d_m;
    }
    if (!(a > 0)) break;
    pose.rotation = rotation_from_vector(-g / a * axis) * pose.rotation;
    if (std::abs(g / a) < 1e-5) break;
  }
  return pose;
}

// How many of the matches hold at a pose.
double matches_held(const std::vector<PointOnPlane>& matches, const Pose& pose, double width_m) {
  double held = 0;
  for (const PointOnPlane& match : matches) held += cauchy_weight(distance_m(match, pose), width_m);
  return held;
}

double rms_apart_m(const std::vector<PointOnPlane>& matches, const Pose& one, const Pose& other) {
  double squares_m2 = 0;
  for (const PointOnPlane& match : matches) {
    const double apart_m = match.patch.normal.dot(one * match.p_m - other * match.p_m);
    squares_m2 += apart_m * apart_m;
  }
  return std::sqrt(squares_m2 / double(matches.size()));
}

}  // namespace

std::optional<SweepShift> shift_between(const StationaryPoints& points, const LinePool& target,
                                        const LinePool& source, const StationaryGrid& grid) {
  SweepShift shift;
  const std::vector<PointOnPlane> matches = matched_both_ways(points, target, source, grid, shift);
  if (matches.size() < kMinMatches) return std::nullopt;
  // This width, and those that the searches begin with, were found with the bounds of stationary_motion.cpp.
  const double width_m = 0.008 + 1.2 * grid.problem->features->range_noise_m;
  const Pose rest = at_rest(matches, grid.problem->recording->rig.mount.axis.normalized(), width_m);
  const double held_at_rest = matches_held(matches, rest, width_m);
  // From afar a person who walked between the sweeps may be followed; from near by, a walk may be missed. The
  // search from near by may also end where there are few matches: the evidence decides.
  const Pose far = registered(matches, rest, {0.5, width_m, 0.015});
  const Pose near = registered(matches, rest, {0.05, width_m, 0.003});
  shift.far_translation_m = far.translation_m;
  shift.far_rotation_rad = vector_from_rotation(far.rotation).norm();
  shift.far_gained_matches = matches_held(matches, far, width_m) - held_at_rest;
  const double near_gained = matches_held(matches, near, width_m) - held_at_rest;
  const Pose& best = near_gained > shift.far_gained_matches ? near : far;
  shift.gained_matches = std::max(near_gained, shift.far_gained_matches);
  shift.translation_m = best.translation_m;
  shift.rotation_rad = vector_from_rotation(best.rotation).norm();
  shift.apart_m = rms_apart_m(matches, best, rest);
  shift.apart_in_all_m = rms_apart_m(matches, best, Pose());
  return shift;
}

}  // namespace sweepscope
