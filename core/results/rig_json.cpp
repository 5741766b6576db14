#include "core/results/rig_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/numbers.hpp"
#include "core/results/fields.hpp"

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
  return std::sqrt(solved.covariance(unknown, unknown)) * kDegPerRad;
}

Json mount_json(const SolvedRig& solved) {
  const Mount &given = solved.given.mount, &mount = solved.rig.mount;
  const MountSigma sigma = mount_sigma(solved);
  Json object;
  object["axis"] = vector_json(given.axis);
  object["given_rpy_deg"] = vector_json(given.laser_in_motor_rpy_deg);
  object["given_xyz_m"] = vector_json(given.laser_in_motor_xyz_m);
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
  object["given_deg"] = tidy(solved.given.gear.play_deg);
  object["value_deg"] = known ? Json(tidy(solved.rig.gear.play_deg)) : Json(nullptr);
  object["sigma_deg"] = tidy(play_sigma_deg(solved));
  object["prior_deg"] = tidy(solved.priors[kPlay] * kDegPerRad);
  add_finding(object, solved.play);
  return object;
}

Json encoder_json(const SolvedRig& solved) {
  const Rig::Gear& gear = solved.rig.gear;
  Json object;
  object["given_amplitude_deg"] = tidy(solved.given.gear.encoder_amplitude_deg);
  object["given_phase_deg"] = tidy(solved.given.gear.encoder_phase_deg);
  object["amplitude_deg"] = tidy(gear.encoder_amplitude_deg);
  object["phase_deg"] = tidy(gear.encoder_phase_deg);
  object["sigma_sine_deg"] = tidy(sigma_deg(solved, kEncoderSine));
  object["sigma_cosine_deg"] = tidy(sigma_deg(solved, kEncoderCosine));
  object["sigma_deg"] = tidy(encoder_sigma_deg(solved));
  object["prior_deg"] = tidy(solved.priors[kEncoderSine] * kDegPerRad);
  add_finding(object, solved.encoder);
  return object;
}

constexpr std::array kUnknownNames{"offset",        "mount_turn_1", "mount_turn_2", "mount_shift_1",
                                   "mount_shift_2", "play",         "encoder_sine", "encoder_cosine"};

Json correlation_json(const SolvedRig& solved) {
  Json names = Json::array(), sigma = Json::array(), matrix = Json::array();
  std::vector<int> solved_for;
  for (int i = 0; i < kRigUnknowns; ++i)
    if (i == kOffset || solved.priors[i] > 0) solved_for.push_back(i);
  for (const int i : solved_for) {
    names.push_back(kUnknownNames[std::size_t(i)]);
    sigma.push_back(std::sqrt(solved.covariance(i, i)));
    Json row = Json::array();
    for (const int j : solved_for) {
      const double both = std::sqrt(solved.covariance(i, i) * solved.covariance(j, j));
      row.push_back(both > 0 ? tidy(solved.covariance(i, j) / both) : (i == j ? 1.0 : 0.0));
    }
    matrix.push_back(std::move(row));
  }
  return {{"of", std::move(names)}, {"sigma", std::move(sigma)}, {"matrix", std::move(matrix)}};
}

RigFinding finding_of(const Json& object) {
  return {true, object.at("identifiable").get<bool>(), object.value("reason", std::string())};
}

void read_mount(const Json& object, SolvedRig& solved) {
  solved.mount = finding_of(object);
  solved.along_walk = !object.value("shift_identifiable", true);
  solved.given.mount = {vector_of(object, "axis"), vector_of(object, "given_xyz_m"),
                        vector_of(object, "given_rpy_deg")};
  solved.rig.mount = {solved.given.mount.axis, vector_of(object, "xyz_m"), vector_of(object, "rpy_deg")};
  solved.priors[kTurnU] = solved.priors[kTurnV] = object.at("prior_deg").get<double>() * kRadPerDeg;
  solved.priors[kShiftU] = solved.priors[kShiftV] = object.at("prior_m").get<double>();
}

void read_play(const Json& object, SolvedRig& solved) {
  solved.play = finding_of(object);
  solved.given.gear.play_deg = solved.rig.gear.play_deg = object.at("given_deg").get<double>();
  if (solved.play.identifiable) solved.rig.gear.play_deg = object.at("value_deg").get<double>();
  solved.priors[kPlay] = object.at("prior_deg").get<double>() * kRadPerDeg;
}

void read_encoder(const Json& object, SolvedRig& solved) {
  solved.encoder = finding_of(object);
  solved.given.gear.encoder_amplitude_deg = object.at("given_amplitude_deg").get<double>();
  solved.given.gear.encoder_phase_deg = object.at("given_phase_deg").get<double>();
  solved.rig.gear.encoder_amplitude_deg = object.at("amplitude_deg").get<double>();
  solved.rig.gear.encoder_phase_deg = object.at("phase_deg").get<double>();
  solved.priors[kEncoderSine] = solved.priors[kEncoderCosine] =
      object.at("prior_deg").get<double>() * kRadPerDeg;
}

void read_covariance(const Json& correlation, SolvedRig& solved) {
  const auto names = correlation.at("of").get<std::vector<std::string>>();
  const auto sigma = correlation.at("sigma").get<std::vector<double>>();
  const auto matrix = correlation.at("matrix").get<std::vector<std::vector<double>>>();
  std::vector<std::ptrdiff_t> unknowns;
  for (const std::string& name : names)
    unknowns.push_back(std::ranges::find(kUnknownNames, name) - kUnknownNames.begin());
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = 0; j < names.size(); ++j)
      if (unknowns[i] < kRigUnknowns && unknowns[j] < kRigUnknowns)
        solved.covariance(unknowns[i], unknowns[j]) = matrix.at(i).at(j) * sigma.at(i) * sigma.at(j);
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

double play_sigma_deg(const SolvedRig& solved) {
  return sigma_deg(solved, kPlay);
}

double encoder_sigma_deg(const SolvedRig& solved) {
  return std::hypot(sigma_deg(solved, kEncoderSine), sigma_deg(solved, kEncoderCosine)) / std::sqrt(2.0);
}

nlohmann::ordered_json rig_parameters_json(const SolvedRig& solved) {
  Json object;
  if (solved.mount.solved) object["mount"] = mount_json(solved);
  if (solved.play.solved) object["play"] = play_json(solved);
  if (solved.encoder.solved) object["encoder"] = encoder_json(solved);
  object["correlation"] = correlation_json(solved);
  object["residual_before_m"] = tidy(solved.residual_before_m);
  object["residual_after_m"] = tidy(solved.residual_after_m);
  if (!solved.residuals.before.empty()) {
    object["pattern_before_m"] = tidy(solved.residuals.before.rms_m());
    object["pattern_after_m"] = tidy(solved.residuals.after.rms_m());
  }
  object["unevenness_m"] = tidy(solved.unevenness_m);
  object["points"] = solved.points;
  object["surfaces"] = solved.surfaces;
  object["iterations"] = solved.iterations;
  object["converged"] = solved.converged;
  return object;
}

std::optional<SolvedRig> solved_rig_of(const nlohmann::ordered_json& parameters) {
  SolvedRig solved;
  solved.priors.setZero();
  try {
    if (parameters.contains("mount")) read_mount(parameters.at("mount"), solved);
    if (parameters.contains("play")) read_play(parameters.at("play"), solved);
    if (parameters.contains("encoder")) read_encoder(parameters.at("encoder"), solved);
    read_covariance(parameters.at("correlation"), solved);
    solved.residual_before_m = parameters.at("residual_before_m").get<double>();
    solved.residual_after_m = parameters.at("residual_after_m").get<double>();
    solved.unevenness_m = parameters.at("unevenness_m").get<double>();
    solved.points = parameters.at("points").get<std::size_t>();
    solved.surfaces = parameters.at("surfaces").get<std::size_t>();
    solved.iterations = parameters.at("iterations").get<int>();
    solved.converged = parameters.at("converged").get<bool>();
  } catch (const Json::exception&) {
    return std::nullopt;
  } catch (const std::out_of_range&) {  // a matrix of another size
    return std::nullopt;
  }
  return solved;
}

}  // namespace sweepscope
