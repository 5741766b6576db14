#include "core/offset/walk/motion_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/offset/prepared/search_window.hpp"
#include "core/offset/walk/walk.hpp"

namespace sweepscope {
namespace {

// Seconds since the recording's first scan.
std::string span_text(double from_s, double to_s) {
  return fmt::format("from {:.3f} to {:.3f} s", from_s, to_s);
}

bool overlap(const Recording& recording, const GivenMotion& motion) {
  constexpr double kMin_s = 3;  // as correlate_turns needs
  const double from_s = std::max(recording.scans.front().first_beam_s, motion.begin_s());
  const double to_s = std::min(recording.scans.back().last_beam_s(), motion.end_s());
  return to_s - from_s > kMin_s;
}

Error no_overlap(const Recording& recording, const MotionSource& source) {
  const double first_s = recording.scans.front().first_beam_s;
  return {ExitCode::kUnreadableInput,
          fmt::format("{}: the poses do not overlap the recording {}: counted from its first scan they last "
                      "{}, the scans {}, and no time shift makes their rotation match the rig's.",
                      source.name, recording.name,
                      span_text(source.motion.begin_s() - first_s, source.motion.end_s() - first_s),
                      span_text(0, recording.scans.back().last_beam_s() - first_s))};
}

// One way to follow the walk, for its turns alone.
struct Attempt {
  double offset_s;
  bool guided;  // by the motion without a time shift
};

// From the first walk that leaves no doubt: a rig that turns fast may be followed with luck alone.
Result<std::optional<TimeShift>> shift_of_turns(const OffsetProblem& problem, double offset_s,
                                                const MappingOptions& mapping, const GivenMotion& motion,
                                                bool overlaps, const Job& job) {
  constexpr double kAside_units = 3;  // twice as far as the coarse search errs in coarse_search_test
  const SearchScale scale = search_scale(problem.motor);
  const double aside_s = kAside_units * scale.unit_s;
  for (const Attempt& attempt : {Attempt{offset_s, false}, Attempt{offset_s, true},
                                 Attempt{offset_s - aside_s, false}, Attempt{offset_s + aside_s, false}}) {
    if (attempt.guided && !overlaps) continue;
    WalkOptions options = walk_options(mapping, scale);
    options.max_passes = 1;
    if (attempt.guided)
      options.mapping.given = options.joint.mapping.given =
          std::make_shared<const GivenMotion>(motion.as_prior());
    const auto walk = solve_walk(problem, attempt.offset_s, options, job);
    if (!walk) return failure(ExitCode::kInterrupted, "interrupted while tracking");
    const auto found = correlate_turns(walk->joint ? walk->joint->sweeps : walk->sweeps, motion);
    if (found && found->clear) return found->shift;
  }
  return std::nullopt;
}

}  // namespace

UsedMotion MotionSource::used(const std::optional<TimeShift>& shift) const {
  UsedMotion used;
  used.kind = kind;
  used.name = name;
  used.trusted = motion.is_truth();
  if (shift) used.time_shift_s = shift->time_s;
  if (shift && shift->sigma_s > 0) used.time_shift_sigma_s = shift->sigma_s;
  return used;
}

std::optional<MotionSource> motion_source(const Recording& recording,
                                          const std::optional<GivenPoses>& poses) {
  using Kind = UsedMotion::Kind;
  using Role = GivenMotion::Role;
  constexpr auto kAll = GivenMotion::Parts::kRotationAndTranslation;
  if (poses)
    return MotionSource{Kind::kPoses, poses->file,
                        GivenMotion(poses->poses, kAll, poses->trusted ? Role::kTruth : Role::kPrior)};
  if (recording.odometry.size() > 1)
    return MotionSource{Kind::kOdometry, *recording.rig.odometry.topic,
                        GivenMotion(recording.odometry, kAll, Role::kPrior)};
  if (recording.turn_rates.time_s.size() > 1)
    return MotionSource{
        Kind::kImu, *recording.rig.imu.topic,
        GivenMotion::from_rates(recording.turn_rates.time_s, recording.turn_rates.rate_rad_s)};
  return std::nullopt;
}

Result<AlignedMotion> align_motion(const OffsetProblem& problem, double offset_s,
                                   const MappingOptions& mapping, const MotionSource& source,
                                   const Job& job) {
  const bool overlaps = overlap(*problem.recording, source.motion);
  auto shift = shift_of_turns(problem, offset_s, mapping, source.motion, overlaps, job);
  if (!shift) return tl::unexpected(shift.error());
  AlignedMotion aligned;
  if (!*shift && !overlaps) return tl::unexpected(no_overlap(*problem.recording, source));
  if (!*shift && !source.motion.is_truth()) {
    aligned.warnings.push_back(fmt::format(
        "{} is not used: its time shift cannot be determined from the rig's rotation.", source.name));
    return aligned;
  }
  if (*shift)
    aligned.shift = **shift;
  else
    aligned.warnings.push_back(fmt::format(
        "The time shift of {} cannot be determined from the rig's rotation; it is assumed to be near 0.",
        source.name));
  aligned.motion = std::make_shared<const GivenMotion>(
      source.motion.with_time_shift(aligned.shift ? aligned.shift->time_s : 0));
  return aligned;
}

}  // namespace sweepscope
