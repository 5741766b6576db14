#pragma once

#include <nlohmann/json.hpp>

#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// "parameters" of an estimate: the parts of the rig that were solved for, with what they were thought to be
/// before, what correlates with what, and how flat walls are before and after.
nlohmann::ordered_json rig_parameters_json(const SolvedRig& solved);

/// How uncertain a mount is, per axis of its pose in the motor's frame. What turns about the motor's axis, or
/// shifts along it, is not observable and not counted.
struct MountSigma {
  Eigen::Vector3d xyz_m, rpy_deg;
};
MountSigma mount_sigma(const SolvedRig& solved);

}  // namespace sweepscope
