#pragma once

// The mathematics: docs/algorithms.md, section 13.3.

#include <cstddef>
#include <optional>
#include <string>

#include "core/recording/recording.hpp"
#include "core/recording/sweeps.hpp"

namespace sweepscope {

/// A warning about a recording that determines its offset poorly: a sentence, absent if there is nothing to
/// report.
using Remark = std::optional<std::string>;

/// All sweeps measure at the same angles: few surfaces are measured twice.
Remark aliased_warning(const Recording& recording, const MotorMotion& motor);
/// The encoder's samples are uneven in time.
Remark encoder_warning(const MotorTrack& track);
/// A sweep has few samples of the motor.
Remark sampling_warning(const MotorTrack& track, const MotorMotion& motor);
Remark slow_motor_warning(const MotorMotion& motor);
Remark few_matches_warning(std::size_t matches, std::size_t features);

}  // namespace sweepscope
