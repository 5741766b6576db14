#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/joint_walk.hpp"
#include "core/offset/search_window.hpp"

namespace sweepscope {

struct WalkOptions {
  MappingOptions mapping;
  JointWalkOptions joint;
  int max_passes = 5;
  double step_tolerance_s = 0.5e-3;  // the trajectory was tracked near enough to the offset that fits it
  double shift_tolerance_s = 2e-3;   // and to the time shift of a given motion
  double max_step_s = 0.006;
  double max_sigma_s = 1e-3;    // beyond, further passes would say no more
  std::size_t min_sweeps = 20;  // that are tracked
};

/// For a motor of this scale.
WalkOptions walk_options(const MappingOptions& mapping, const SearchScale& scale);

/// A walk as far as it can be told: its trajectory, tracked at an offset near the one that fits best, and
/// that offset. All that is judged or drawn of a walk goes by this one trajectory.
struct SolvedWalk {
  std::vector<SweepPose> sweeps;
  double tracked_at_s = 0;         // the offset that the sweeps were placed with
  bool lost = false;               // too few sweeps could be tracked
  bool near = false;               // tracked at nearly the offset that fits
  std::optional<JointWalk> joint;  // absent where too few points match
};

/// Tracks the walk and solves for walk and offset together, in turn, from an offset within some milliseconds
/// of the truth. Absent where the job was cancelled.
std::optional<SolvedWalk> solve_walk(const OffsetProblem& problem, double first_offset_s,
                                     const WalkOptions& options, const Job& job);

/// The same without an offset to start from: of those the motor allows about `middle_s`, the one that fits
/// best as if the rig had stood still (see search_coarsely), which motion blurs but hardly shifts.
std::optional<SolvedWalk> find_walk(const OffsetProblem& problem, double middle_s,
                                    const MappingOptions& mapping, const Job& job);

/// When the sweeps are lost, in seconds since the recording's first scan.
std::vector<Interval> lost_times(const std::vector<SweepPose>& sweeps, const Recording& recording);
/// What to say of those times; nothing where there are none.
std::optional<std::string> lost_warning(const std::vector<Interval>& lost);
/// Why nothing can be said of a walk that is lost, and what would help.
std::string lost_reason(const SolvedWalk& walk, const Recording& recording);

}  // namespace sweepscope
