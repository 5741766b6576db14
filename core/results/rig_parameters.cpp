#include "core/results/rig_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/numbers.hpp"
#include "core/results/rig_json.hpp"

namespace sweepscope {
namespace {

using State = RigParameter::State;

RigParameter parameter(const RigFinding& finding, const char* part, std::string name, const char* unit,
                       double given, double found, double sigma, double prior) {
  const State state = finding.identifiable ? State::kFound : State::kNotDetermined;
  if (state == State::kNotDetermined) return {part, std::move(name), unit, given, given, {}, prior, state};
  return {part, std::move(name), unit, given, found, sigma, prior, state};
}

// Along the motor's axis an angle or a shift is a gauge, which no sigma belongs to.
RigParameter of_mount(const SolvedRig& solved, const char* name, const char* unit, double given, double found,
                      double sigma, double prior) {
  constexpr double kNone = 1e-12;
  const std::string full = fmt::format("mount {}", name);
  if (sigma < kNone) return {"mount", full, unit, given, found, {}, {}, State::kGauge};
  return parameter(solved.mount, "mount", full, unit, given, found, sigma, prior);
}

void add_mount(std::vector<RigParameter>& all, const SolvedRig& solved) {
  static constexpr std::array kAngles{"roll", "pitch", "yaw"}, kShifts{"x", "y", "z"};
  const Mount &given = solved.given.mount, &found = solved.rig.mount;
  const MountSigma sigma = mount_sigma(solved);
  for (int i = 0; i < 3; ++i)
    all.push_back(of_mount(solved, kAngles[std::size_t(i)], "deg", given.laser_in_motor_rpy_deg[i],
                           found.laser_in_motor_rpy_deg[i], sigma.rpy_deg[i],
                           solved.priors[kTurnU] * kDegPerRad));
  for (int i = 0; i < 3; ++i)
    all.push_back(of_mount(solved, kShifts[std::size_t(i)], "mm", given.laser_in_motor_xyz_m[i] * 1e3,
                           found.laser_in_motor_xyz_m[i] * 1e3, sigma.xyz_m[i] * 1e3,
                           solved.priors[kShiftU] * 1e3));
  if (!solved.along_walk) return;
  for (RigParameter& parameter : all)
    if (parameter.unit == "mm" && parameter.state == State::kFound) {
      parameter.state = State::kNotDetermined;
      parameter.sigma.reset();
    }
}

void add_encoder(std::vector<RigParameter>& all, const SolvedRig& solved) {
  const Rig::Gear &given = solved.given.gear, &found = solved.rig.gear;
  const double sigma_deg = encoder_sigma_deg(solved);
  all.push_back(parameter(solved.encoder, "encoder", "encoder amplitude", "deg", given.encoder_amplitude_deg,
                          found.encoder_amplitude_deg, sigma_deg, solved.priors[kEncoderSine] * kDegPerRad));
  RigParameter phase = parameter(solved.encoder, "encoder", "encoder phase", "deg", given.encoder_phase_deg,
                                 found.encoder_phase_deg, 0, 0);
  phase.prior.reset();
  phase.sigma.reset();
  const double amplitude_deg = found.encoder_amplitude_deg;
  if (solved.encoder.identifiable && amplitude_deg > sigma_deg)
    phase.sigma = sigma_deg / amplitude_deg * kDegPerRad;
  all.push_back(std::move(phase));
}

// Two digits of the uncertainty, or three of the value.
int decimals_of(const RigParameter& parameter) {
  const double size =
      parameter.sigma.value_or(0) > 0 ? *parameter.sigma / 10 : std::abs(parameter.found) / 100;
  if (!(size > 0)) return 2;
  return std::clamp(-static_cast<int>(std::floor(std::log10(size) + 1e-9)), 0, 4);
}

}  // namespace

std::vector<RigParameter> rig_parameters(const SolvedRig& solved) {
  std::vector<RigParameter> all;
  if (solved.mount.solved) add_mount(all, solved);
  if (solved.play.solved)
    all.push_back(parameter(solved.play, "play", "gear play", "deg", solved.given.gear.play_deg,
                            solved.rig.gear.play_deg, play_sigma_deg(solved),
                            solved.priors[kPlay] * kDegPerRad));
  if (solved.encoder.solved) add_encoder(all, solved);
  return all;
}

std::string in_words(const RigParameter& parameter) {
  const std::string unit = parameter.unit == "deg" ? "°" : " " + parameter.unit;
  if (parameter.state == State::kNotDetermined) return "not determined";
  const int decimals = decimals_of(parameter);
  const auto number = [&](double value) {
    const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
    const bool zero = text.find_first_not_of("0.") == text.npos;
    return (value < 0 && !zero ? "−" : "") + text;
  };
  if (parameter.state == State::kGauge) return number(parameter.found) + unit + ", kept";
  if (!parameter.sigma) return number(parameter.found) + unit;
  return number(parameter.found) + " ± " + number(*parameter.sigma) + unit;
}

std::string residual_text(const SolvedRig& solved) {
  const std::string sizes = fmt::format("{:.2f} mm with the rig file and {:.2f} mm with the rig found",
                                        solved.residual_before_m * 1e3, solved.residual_after_m * 1e3);
  if (solved.along_walk)
    return fmt::format("Points lie {} from their matches; {} matches.", sizes, solved.points);
  return fmt::format("Points lie {} from flat surfaces; {} points on {} surfaces.", sizes, solved.points,
                     solved.surfaces);
}

std::vector<std::string> reasons_of(const SolvedRig& solved) {
  std::vector<std::string> reasons;
  for (const RigFinding& part : {solved.mount, solved.play, solved.encoder})
    if (!part.reason.empty()) reasons.push_back(part.reason);
  return reasons;
}

}  // namespace sweepscope
