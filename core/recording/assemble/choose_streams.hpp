#pragma once

#include "core/error.hpp"
#include "core/recording/raw_recording.hpp"

namespace sweepscope {

/// Which of RawRecording::lasers is the scanner: the one that the rig names, or the only one. Else a refusal
/// that lists the choices.
Result<std::size_t> choose_laser(const RawRecording& raw, const Rig& rig);

/// Which of RawRecording::joints is the motor: the one that the rig names, the only one that moves (by more
/// than 1 deg), or the only one there is; where the rig names no topic, of the best JointSource alone. Else a
/// refusal that lists the choices: a robot's wheels move as well, and how a joint moves does not tell what it
/// carries.
Result<std::size_t> choose_joint(const RawRecording& raw, const Rig& rig);

}  // namespace sweepscope
