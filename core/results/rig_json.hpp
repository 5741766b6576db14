#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// "parameters" of an estimate: the parts of the rig that were solved for with their priors, the correlation
/// matrix and the standard deviations of the unknowns (s, rad, m), and the flatness of walls before and
/// after.
nlohmann::ordered_json rig_parameters_json(const SolvedRig& solved);

/// Reads them back, without the residuals over motor angle and beam. Absent where values are missing, as in
/// files of older versions.
std::optional<SolvedRig> solved_rig_of(const nlohmann::ordered_json& parameters);

/// Standard deviations of a mount's rpy and xyz. The turn about the motor's axis and the shift along it are
/// unobservable and not included.
struct MountSigma {
  Eigen::Vector3d xyz_m, rpy_deg;
};
MountSigma mount_sigma(const SolvedRig& solved);
/// Standard deviation of the gear play, and of a component of the encoder's first harmonic.
double play_sigma_deg(const SolvedRig& solved);
double encoder_sigma_deg(const SolvedRig& solved);

}  // namespace sweepscope
