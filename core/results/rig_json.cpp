#include "core/results/rig_json.hpp"

#include <array>
#include <cmath>

#include "core/numbers.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

// Rounded to six decimals, without -0.
double tidy(double value) {
  return std::round(value * 1e6) / 1e6 + 0.0;
}

Json vector_json(const Eigen::Vector3d& v) {
  return {tidy(v.x()), tidy(v.y()), tidy(v.z())};
}

void add_finding(Json& object, const RigFinding& finding) {
  object["identifiable"] = finding.identifiable;
  if (!finding.reason.empty()) object["reason"] = finding.reason;
}

double sigma_deg(const SolvedRig& solved, RigUnknown unknown) {
  return tidy(std::sqrt(solved.covariance(unknown, unknown)) * kDegPerRad);
}

Json mount_json(const SolvedRig& solved) {
  const Mount& mount = solved.rig.mount;
  const MountSigma sigma = mount_sigma(solved);
  Json object;
  object["rpy_deg"] = vector_json(mount.laser_in_motor_rpy_deg);
  object["xyz_m"] = vector_json(mount.laser_in_motor_xyz_m);
  object["sigma_rpy_deg"] = vector_json(sigma.rpy_deg);
  object["sigma_xyz_m"] = vector_json(sigma.xyz_m);
  object["prior_deg"] = tidy(solved.priors[kTurnU] * kDegPerRad);
  object["prior_m"] = tidy(solved.priors[kShiftU]);
  object["gauge"] = "the turn about the motor's axis and the shift along it are the rig file's";
  add_finding(object, solved.mount);
  if (solved.mount.identifiable) object["shift_identifiable"] = !solved.along_walk;
  return object;
}

Json play_json(const SolvedRig& solved) {
  Json object;
  const bool known = solved.play.identifiable;
  object["value_deg"] = known ? Json(tidy(solved.rig.gear.play_deg)) : Json(nullptr);
  object["sigma_deg"] = sigma_deg(solved, kPlay);
  object["prior_deg"] = tidy(solved.priors[kPlay] * kDegPerRad);
  add_finding(object, solved.play);
  return object;
}

Json encoder_json(const SolvedRig& solved) {
  const Rig::Gear& gear = solved.rig.gear;
  Json object;
  object["amplitude_deg"] = tidy(gear.encoder_amplitude_deg);
  object["phase_deg"] = tidy(gear.encoder_phase_deg);
  object["sigma_sine_deg"] = sigma_deg(solved, kEncoderSine);
  object["sigma_cosine_deg"] = sigma_deg(solved, kEncoderCosine);
  object["sigma_deg"] =
      tidy(std::hypot(sigma_deg(solved, kEncoderSine), sigma_deg(solved, kEncoderCosine)) / std::sqrt(2.0));
  object["prior_deg"] = tidy(solved.priors[kEncoderSine] * kDegPerRad);
  add_finding(object, solved.encoder);
  return object;
}

Json correlation_json(const SolvedRig& solved) {
  static constexpr std::array kNames{"offset",        "mount_turn_1", "mount_turn_2", "mount_shift_1",
                                     "mount_shift_2", "play",         "encoder_sine", "encoder_cosine"};
  Json names = Json::array(), matrix = Json::array();
  std::vector<int> solved_for;
  for (int i = 0; i < kRigUnknowns; ++i)
    if (i == kOffset || solved.priors[i] > 0) solved_for.push_back(i);
  for (const int i : solved_for) {
    names.push_back(kNames[std::size_t(i)]);
    Json row = Json::array();
    for (const int j : solved_for) {
      const double both = std::sqrt(solved.covariance(i, i) * solved.covariance(j, j));
      row.push_back(both > 0 ? tidy(solved.covariance(i, j) / both) : (i == j ? 1.0 : 0.0));
    }
    matrix.push_back(std::move(row));
  }
  return {{"of", std::move(names)}, {"matrix", std::move(matrix)}};
}

}  // namespace

MountSigma mount_sigma(const SolvedRig& solved) {
  // Finite differences, since roll, pitch and yaw have no simple derivative.
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, 3, 2> rpy_deg, xyz_m;
  const Mount& mount = solved.rig.mount;
  for (int i = 0; i < 2; ++i) {
    RigUnknowns step;
    step.turn_rad[i] = kStep;
    rpy_deg.col(i) = (changed(mount, step).laser_in_motor_rpy_deg - mount.laser_in_motor_rpy_deg) / kStep;
  }
  xyz_m = across_axis(mount.axis);
  const Eigen::Matrix2d turn = solved.covariance.block<2, 2>(kTurnU, kTurnU),
                        shift = solved.covariance.block<2, 2>(kShiftU, kShiftU);
  return {(xyz_m * shift * xyz_m.transpose()).diagonal().cwiseMax(0).cwiseSqrt(),
          (rpy_deg * turn * rpy_deg.transpose()).diagonal().cwiseMax(0).cwiseSqrt()};
}

nlohmann::ordered_json rig_parameters_json(const SolvedRig& solved) {
  Json object;
  if (solved.mount.solved) object["mount"] = mount_json(solved);
  if (solved.play.solved) object["play"] = play_json(solved);
  if (solved.encoder.solved) object["encoder"] = encoder_json(solved);
  object["correlation"] = correlation_json(solved);
  object["residual_before_m"] = tidy(solved.residual_before_m);
  object["residual_after_m"] = tidy(solved.residual_after_m);
  object["pattern_before_m"] = tidy(solved.residuals.before.rms_m());
  object["pattern_after_m"] = tidy(solved.residuals.after.rms_m());
  object["unevenness_m"] = tidy(solved.unevenness_m);
  object["points"] = solved.points;
  object["surfaces"] = solved.surfaces;
  object["iterations"] = solved.iterations;
  object["converged"] = solved.converged;
  return object;
}

}  // namespace sweepscope
