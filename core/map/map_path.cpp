#include "core/map/map_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/loam/path/given_motion.hpp"
#include "core/map/stamped_poses.hpp"
#include "core/numbers.hpp"
#include "core/offset/judgement/identifiability.hpp"
#include "core/offset/kind/stationary_motion.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "core/offset/walk/ways.hpp"

namespace sweepscope {
namespace {

// Whether the rig is taken to have moved.
bool taken_for_moving(const OffsetProblem& problem, double offset_s, const MapOptions& options) {
  if (options.assume) return *options.assume == RigKind::kMoving;
  if (!options.poses.empty() || options.walk) return true;
  return test_motion(stationary_grid(problem), offset_s).moving();
}

// An offset that cannot be found does not blur a map either: it is a gauge.
bool any_offset_serves(const Refusal& refusal) {
  return refusal.kind == RefusalKind::kOneWayAtOneSpeed;
}

std::string gauge_warning(const OffsetProblem& problem) {
  const auto refused = motor_refusal(problem.recording->motor, problem.motor);
  if (!refused || !any_offset_serves(*refused)) return "";
  return fmt::format(
      "The motor turns one way at one speed: any offset gives this map but for a turn about the motor's axis, "
      "{:.2g} deg for each millisecond. What blurs it is the mount (`estimate --solve mount`).",
      problem.motor.median_speed_rad_s * kDegPerRad / 1e3);
}

// Why no map can be built at all.
Result<void> check_scans(const OffsetProblem& problem, double offset_s) {
  const Recording& recording = *problem.recording;
  if (const auto refused = motor_refusal(recording.motor, problem.motor);
      refused && !any_offset_serves(*refused))
    return failure(ExitCode::kNotIdentifiable, fmt::format("{}: {}", recording.name, refused->text));
  const std::vector<std::size_t> sweep_of = assign_sweeps(recording.scans, problem.motor.sweeps, offset_s);
  for (std::size_t i = 0; i < sweep_of.size(); ++i)
    if (problem.scan_used[i] != 0 && sweep_of[i] != kNoSweep) return {};
  return failure(
      ExitCode::kNotIdentifiable,
      fmt::format("{}: no scan is covered by the motor's samples at these offsets.", recording.name));
}

// Where a walk is searched for: at the one offset that is asked for; between several in whole units, as in an
// estimate, since it would be tracked twice from half a unit beside the offset that fits.
double middle_of_search_s(const OffsetProblem& problem, double from_s, double to_s) {
  const double middle_s = (from_s + to_s) / 2;
  if (from_s == to_s || problem.motor.one_way()) return middle_s;
  const double unit_s = search_scale(problem.motor).unit_s;
  return unit_s * std::round(middle_s / unit_s);
}

// The poses of all sweeps that a SweepPlacer has at an offset; those that the path lacks are lost.
std::vector<SweepPose> poses_of_sweeps(const OffsetProblem& problem, const MapPath& path, double offset_s) {
  const std::vector<std::size_t> sweep_of =
      assign_sweeps(problem.recording->scans, problem.motor.sweeps, offset_s);
  std::optional<GivenMotion> given;
  if (!path.walk)
    given.emplace(path.poses, GivenMotion::Parts::kRotationAndTranslation, GivenMotion::Role::kTruth);
  std::vector<SweepPose> poses;
  for (std::size_t i = 0; i < sweep_of.size(); ++i) {
    if (problem.scan_used[i] == 0 || sweep_of[i] == kNoSweep) continue;
    if (!poses.empty() && poses.back().sweep == sweep_of[i]) continue;
    const Sweep& sweep = problem.motor.sweeps[sweep_of[i]];
    SweepPose pose;
    pose.sweep = sweep_of[i];
    pose.direction = sweep.direction;
    pose.begin_s = sweep.begin_s - offset_s;
    pose.end_s = sweep.end_s - offset_s;
    pose.lost = true;
    if (path.walk) {
      const auto solved = std::ranges::lower_bound(path.walk->sweeps, pose.sweep, {}, &SweepPose::sweep);
      if (solved != path.walk->sweeps.end() && solved->sweep == pose.sweep) pose = *solved;
    } else if (poses_cover(path.poses, pose.begin_s, pose.end_s)) {
      pose = along(*given, pose, given->at(pose.begin_s), pose.begin_s, MappingOptions().knot_s);
      pose.lost = false;
    }
    poses.push_back(std::move(pose));
  }
  return poses;
}

void add_warning(MapPath& path, const std::string& warning) {
  path.warning += (path.warning.empty() || warning.empty() ? "" : " ") + warning;
}

// Wheels, a camera or poses then show the motion where the surfaces do not.
bool followed_given_motion(const SolvedWalk& walk) {
  return walk.joint && walk.joint->time_shift;
}

// Adds the consistency of the path with its warnings. A solved path has an offset of its own.
Result<MapPath> checked(const OffsetProblem& problem, MapPath path, const Job& job, double offset_s = 0) {
  if (path.lost()) return path;
  if (path.walk) offset_s = path.walk->tracked_at_s;
  auto found = map_consistency(problem, poses_of_sweeps(problem, path, offset_s), offset_s, job);
  if (!found) return failure(ExitCode::kInterrupted, "interrupted while building the map");
  if (path.walk && !path.walk->contradiction.empty()) {
    constexpr double kDoubt = 2;  // as that of surfaces twice as far apart as they may be
    found->warnings.push_back(path.walk->contradiction);
    found->doubt = std::max(found->doubt, kDoubt);
  }
  if (found->drift_warning && path.walk && !followed_given_motion(*path.walk))
    found->warnings.push_back(*found->drift_warning);
  for (const std::string& warning : found->warnings) add_warning(path, warning);
  path.consistency = std::make_shared<const MapConsistency>(std::move(*found));
  return path;
}

Result<MapPath> along_walk(const OffsetProblem& problem, MapPath path, std::shared_ptr<const SolvedWalk> walk,
                           const Job& job) {
  path.walk = std::move(walk);
  add_warning(path, pieces_warning(path.walk->sweeps, *problem.recording).value_or(""));
  return checked(problem, std::move(path), job);
}

// The smaller, the better the map agrees with itself, and then the better its features fit each other.
std::pair<double, double> doubt_of(const MapPath& path) {
  return {path.consistency ? path.consistency->doubt : std::numeric_limits<double>::infinity(),
          path.walk->misfit_m};
}

bool is_doubtful(const MapPath& path) {
  return path.consistency && !path.consistency->agrees_with_itself();
}

// The path along a walk. Where its map does not agree with itself, or its tracks contradict each other, the
// walk is tracked in other ways. Of those that fit nearly equally well the one whose map agrees best is
// taken.
Result<MapPath> along_best_walk(const OffsetProblem& problem, const MapPath& path,
                                const std::shared_ptr<const SolvedWalk>& walk, const MappingOptions& mapping,
                                const Job& job) {
  constexpr double kNearlyEqually = 1.05;  // tuned on tests/benchmark/worlds, seeds 80, 81 and 300
  auto first = along_walk(problem, path, walk, job);
  if (!first || !is_doubtful(*first) || walk->tracked_again) return first;
  const auto ways = ways_to_track(problem, *walk, mapping, job);
  if (!ways) return failure(ExitCode::kInterrupted, "interrupted while building the map");
  std::optional<MapPath> best;
  for (const SolvedWalk& way : ways->walks) {
    if (way.misfit_m > kNearlyEqually * best_fitting(*ways).misfit_m) continue;
    SolvedWalk judged = way;
    judged.contradiction = contradiction_of(way, *ways, first->consistency->limit_m, *problem.recording);
    judged.tracked_again = true;
    auto found = along_walk(problem, path, std::make_shared<const SolvedWalk>(std::move(judged)), job);
    if (!found) return found;
    if (!best || doubt_of(*found) < doubt_of(*best)) best = std::move(*found);
  }
  return std::move(*best);
}

}  // namespace

Result<MapPath> find_map_path(const PreparedRecording& prepared, double from_s, double to_s,
                              const MapOptions& options, const Job& job) {
  const OffsetProblem problem = problem_for(prepared, from_s, to_s);
  if (const auto checked = check_scans(problem, from_s); !checked) return tl::unexpected(checked.error());
  MapPath path;
  path.moving = taken_for_moving(problem, from_s, options);
  path.used = problem.scan_used;
  path.sweeps = problem.motor.sweeps;
  path.poses = options.poses;
  path.warning = gauge_warning(problem);
  if (!path.poses.empty()) {
    auto covered = check_pose_coverage(*problem.recording, path.poses, path.used);
    if (!covered) return tl::unexpected(covered.error());
    add_warning(path, *covered);
    return checked(problem, std::move(path), job, (from_s + to_s) / 2);
  }
  if (!path.moving) return path;
  std::shared_ptr<const SolvedWalk> walk = options.walk;
  if (!walk) {
    auto solved = find_walk(problem, middle_of_search_s(problem, from_s, to_s), options.mapping,
                            WalkPurpose::kTrajectory, job);
    if (!solved) return failure(ExitCode::kInterrupted, "interrupted while building the map");
    walk = std::make_shared<const SolvedWalk>(std::move(*solved));
  }
  return along_best_walk(problem, path, walk, options.mapping, job);
}

MapPath path_without_solving(const PreparedRecording& prepared, std::vector<char> used,
                             std::vector<StampedPose> poses) {
  constexpr double kForEver_s = 1e9;
  MapPath path;
  path.moving = !poses.empty();
  path.used = std::move(used);
  path.sweeps = prepared.motor.sweeps;
  if (path.sweeps.empty()) path.sweeps.push_back({-kForEver_s, kForEver_s});
  path.poses = std::move(poses);
  return path;
}

}  // namespace sweepscope
