#include "core/map/map_path.hpp"

#include <fmt/format.h>

#include "core/loam/sweep_matcher.hpp"
#include "core/map/pose_reader.hpp"
#include "core/offset/search_window.hpp"
#include "core/offset/still_motion.hpp"

namespace sweepscope {
namespace {

// Whether the rig is taken to have moved.
bool taken_for_moving(const OffsetProblem& problem, double offset_s, const MapOptions& options) {
  if (options.assume) return *options.assume == RigKind::kMoving;
  if (!options.poses.empty() || options.walk) return true;
  return test_motion(still_grid(problem), offset_s).moving();
}

// Why no map can be built at all.
Result<void> check_scans(const OffsetProblem& problem, double offset_s) {
  const Recording& recording = *problem.recording;
  const std::vector<std::string> reasons = motor_reasons(recording.motor, problem.motor);
  if (!reasons.empty())
    return failure(ExitCode::kNotIdentifiable, fmt::format("{}: {}", recording.name, reasons.front()));
  PlacedSweep any;
  if (SweepPlacer(problem, offset_s).next(any)) return {};
  return failure(
      ExitCode::kNotIdentifiable,
      fmt::format("{}: no scan is covered by the motor's samples at these offsets.", recording.name));
}

}  // namespace

std::vector<SweepPose> stationary_poses(const OffsetProblem& problem, double offset_s) {
  std::vector<SweepPose> poses;
  SweepPlacer placer(problem, offset_s);
  for (PlacedSweep sweep; placer.next(sweep);) poses.push_back(pose_of(sweep));
  return poses;
}

Result<MapPath> find_map_path(const OffsetProblem& problem, double from_s, double to_s,
                              const MapOptions& options, const Job& job) {
  if (const auto checked = check_scans(problem, from_s); !checked) return tl::unexpected(checked.error());
  MapPath path;
  path.moving = taken_for_moving(problem, from_s, options);
  if (path.moving) path.walk = options.walk;
  if (!options.poses.empty()) {
    auto covered = check_pose_coverage(*problem.recording, options.poses, problem.scan_used);
    if (!covered) return tl::unexpected(covered.error());
    path.warning = std::move(*covered);
    return path;
  }
  if (!path.moving) return path;
  if (!path.walk) {
    auto solved = find_walk(problem, (from_s + to_s) / 2, options.mapping, job);
    if (!solved) return failure(ExitCode::kInterrupted, "interrupted while building the map");
    path.walk = std::make_shared<const SolvedWalk>(std::move(*solved));
  }
  path.warning = pieces_warning(path.walk->sweeps, *problem.recording).value_or("");
  return path;
}

}  // namespace sweepscope
