#pragma once

#include <nlohmann/json.hpp>

#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// "parameters" of an estimate: the parts of the rig that were solved for with their priors, the correlation
/// matrix, and the flatness of walls before and after.
nlohmann::ordered_json rig_parameters_json(const SolvedRig& solved);

/// Standard deviations of a mount's rpy and xyz. The turn about the motor's axis and the shift along it are
/// unobservable and not included.
struct MountSigma {
  Eigen::Vector3d xyz_m, rpy_deg;
};
MountSigma mount_sigma(const SolvedRig& solved);

}  // namespace sweepscope
