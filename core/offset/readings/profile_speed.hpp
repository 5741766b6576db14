#pragma once

// The mathematics: docs/algorithms.md, section 18.

#include <optional>

#include "core/job.hpp"
#include "core/recording/recording.hpp"

namespace sweepscope {

/// The speed of a motor that nothing measures, with its standard deviation.
struct ProfileSpeed {
  double turns_per_s = 0, sigma_turns_per_s = 0;
};

/// The speed at which the sweeps of a stationary rig fit each other, within what the rig file's profile
/// leaves open (MotorProfile::turns_per_s_within). A wrong speed makes the offset drift; first sweeps are
/// tried at speeds in steps of 0.4 %, then the drift of more and more sweeps corrects the best one. Absent
/// where none fits, as on a walk, or only one that lies outside.
std::optional<ProfileSpeed> find_profile_speed(const Recording& recording, const Job& job);

}  // namespace sweepscope
