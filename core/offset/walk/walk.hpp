#pragma once

// The mathematics: docs/algorithms.md, section 11.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/job.hpp"
#include "core/loam/judged_walk.hpp"
#include "core/loam/mapping.hpp"
#include "core/offset/judgement/limits.hpp"
#include "core/offset/judgement/refusal.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "core/offset/walk/joint_walk.hpp"

namespace sweepscope {

struct WalkOptions {
  MappingOptions mapping;
  JointWalkOptions joint;
  int max_passes = 5;                // a bound: the tolerances below end it
  double step_tolerance_s = 0.5e-3;  // the trajectory was tracked near enough to the offset that fits it
  double shift_tolerance_s = 2e-3;   // and to the time shift of a given motion
  double max_step_s = 0.006;         // of a pass: an offset of more blurs the map that it is matched to
  double max_sigma_s = 1e-3;         // beyond, further passes would say no more
  std::size_t min_sweeps = kLimits.min_tracked_sweeps;
};

/// For a motor of this scale.
WalkOptions walk_options(const MappingOptions& mapping, const SearchScale& scale);

/// A solved walk: its trajectory, tracked at an offset near the one that fits best, and that offset.
/// Everything that is computed or drawn of a walk uses this trajectory.
struct SolvedWalk {
  std::vector<SweepPose> sweeps;
  double tracked_at_s = 0;  // the offset that the sweeps were placed with
  // Of its features, each at most MappingOptions::cost_cap_m; see `adjusted`.
  double misfit_m = std::numeric_limits<double>::infinity();
  bool lost = false;                // too few sweeps could be tracked
  bool near = false;                // tracked at nearly the offset that fits
  bool tracked_again = false;       // in other ways, since its map did not agree with itself
  std::vector<std::size_t> starts;  // at first, see MappingOptions: the best before the others
  std::string contradiction;        // a sentence, if its tracks or these ways contradict each other
  std::optional<JointWalk> joint;   // absent where too few points match
};

/// Alternates between tracking the walk and solving for walk and offset together, from an offset within some
/// milliseconds of the true one; then straightens the walk (see `straightened`) and puts its stretches onto
/// one map, neither of which the offset depends on. Absent if the job was cancelled.
std::optional<SolvedWalk> solve_walk(const OffsetProblem& problem, double first_offset_s,
                                     const WalkOptions& options, const Job& job);

/// What a walk is solved for. The offset of a trajectory need only be near enough to track at.
enum class WalkPurpose { kOffset, kTrajectory };

/// The same without an offset to start from: `middle_s` itself for a motor that turns one way, whose offset a
/// walk does not show (sweeps then are half turns); otherwise of those the motor allows about `middle_s`, the
/// one that fits best for a stationary rig (see search_coarsely): motion blurs this minimum but hardly shifts
/// it.
std::optional<SolvedWalk> find_walk(const OffsetProblem& problem, double middle_s,
                                    const MappingOptions& mapping, WalkPurpose purpose, const Job& job);

/// The walk with another trajectory: tracked at the same offset from its two best starts, with other options.
/// What was solved for together with the offset stays. Absent if the job was cancelled.
std::optional<SolvedWalk> track_again(const OffsetProblem& problem, SolvedWalk walk, MappingOptions mapping,
                                      const Job& job);

/// The same, tracked from sweeps whose poses are known.
std::optional<SolvedWalk> track_from(const OffsetProblem& problem, SolvedWalk walk, KnownSweeps known,
                                     const MappingOptions& mapping, const Job& job);

/// The intervals in which sweeps are lost, in seconds since the recording's first scan.
std::vector<Interval> lost_times(const std::vector<SweepPose>& sweeps, const Recording& recording);
/// The warning about those intervals; absent if there are none.
std::optional<std::string> lost_warning(const std::vector<Interval>& lost);
/// The warning about a map whose stretches do not fit each other; absent if they do.
std::optional<std::string> pieces_warning(const std::vector<SweepPose>& sweeps, const Recording& recording);
/// Why a walk whose track was lost has no answer, and what would help.
Refusal lost_refusal(const SolvedWalk& walk, const Recording& recording);

}  // namespace sweepscope
