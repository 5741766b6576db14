#include "core/results/found_rig.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/results/fields.hpp"
#include "core/results/rig_json.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

void read_part(const Json& object, FoundRig::Part& part) {
  part.identifiable = object.at("identifiable").get<bool>();
  part.reason = object.value("reason", std::string());
}

FoundRig::Mount mount_of(const Json& object) {
  FoundRig::Mount mount;
  read_part(object, mount);
  mount.rpy_deg = vector_of(object, "rpy_deg");
  mount.xyz_m = vector_of(object, "xyz_m");
  mount.sigma_rpy_deg = vector_of(object, "sigma_rpy_deg");
  mount.sigma_xyz_m = vector_of(object, "sigma_xyz_m");
  mount.shift_identifiable = object.value("shift_identifiable", true);
  return mount;
}

FoundRig::Play play_of(const Json& object) {
  FoundRig::Play play;
  read_part(object, play);
  if (!play.identifiable) return play;
  play.value_deg = object.at("value_deg").get<double>();
  play.sigma_deg = object.at("sigma_deg").get<double>();
  return play;
}

FoundRig::Encoder encoder_of(const Json& object) {
  FoundRig::Encoder encoder;
  read_part(object, encoder);
  if (!encoder.identifiable) return encoder;
  encoder.amplitude_deg = object.at("amplitude_deg").get<double>();
  encoder.phase_deg = object.at("phase_deg").get<double>();
  encoder.sigma_deg = object.at("sigma_deg").get<double>();
  return encoder;
}

FoundRig rig_of(const Json& parameters) {
  FoundRig found;
  if (parameters.contains("mount")) found.mount = mount_of(parameters.at("mount"));
  if (parameters.contains("play")) found.play = play_of(parameters.at("play"));
  if (parameters.contains("encoder")) found.encoder = encoder_of(parameters.at("encoder"));
  return found;
}

std::string not_determined(const FoundRig::Part& part, const std::string& source) {
  return fmt::format("not determined by {}, as it was: {}", source, part.reason);
}

std::string mount_note(const FoundRig::Mount& mount, const std::string& source) {
  if (!mount.identifiable) return not_determined(mount, source);
  const Eigen::Vector3d &rpy_deg = mount.sigma_rpy_deg, xyz_mm = mount.sigma_xyz_m * 1e3;
  if (!mount.shift_identifiable)
    return fmt::format(
        "turned as found by {}: +- {:.4f}, {:.4f}, {:.4f} deg; 0 about the motor's axis, where a turn has no "
        "effect. The shift is as it was: {}",
        source, rpy_deg.x(), rpy_deg.y(), rpy_deg.z(), mount.reason);
  return fmt::format(
      "found by {}: +- {:.4f}, {:.4f}, {:.4f} deg and {:.2f}, {:.2f}, {:.2f} mm; 0 where a turn about the "
      "motor's axis or a shift along it has no effect",
      source, rpy_deg.x(), rpy_deg.y(), rpy_deg.z(), xyz_mm.x(), xyz_mm.y(), xyz_mm.z());
}

}  // namespace

FoundRig found_rig(const SolvedRig& solved) {
  return rig_of(rig_parameters_json(solved));
}

Result<FoundRig> parse_found_rig(std::string_view json, std::string_view name) {
  try {
    const Json document = Json::parse(json);
    return document.contains("parameters") ? rig_of(document.at("parameters")) : FoundRig();
  } catch (const Json::exception& wrong) {
    return unreadable(fmt::format("{}: the parameters of the rig cannot be read: {}", name, wrong.what()));
  }
}

DetectedRig with_found(DetectedRig detected, const FoundRig& found, const std::string& source) {
  Rig& rig = detected.rig;
  if (found.mount) detected.mount_note = mount_note(*found.mount, source);
  if (found.mount && found.mount->identifiable) {
    rig.mount.laser_in_motor_rpy_deg = found.mount->rpy_deg;
    rig.mount.laser_in_motor_xyz_m = found.mount->xyz_m;
  }
  if (found.play && found.play->identifiable) {
    rig.gear.play_deg = found.play->value_deg;
    detected.play_note = fmt::format("found by {}: +- {:.4f} deg", source, found.play->sigma_deg);
  } else if (found.play) {
    detected.play_note = not_determined(*found.play, source);
  }
  if (found.encoder && found.encoder->identifiable) {
    rig.gear.encoder_amplitude_deg = found.encoder->amplitude_deg;
    rig.gear.encoder_phase_deg = found.encoder->phase_deg;
    detected.encoder_note = fmt::format("found by {}: +- {:.4f} deg", source, found.encoder->sigma_deg);
  } else if (found.encoder) {
    detected.encoder_note = not_determined(*found.encoder, source);
  }
  return detected;
}

std::string found_rig_file(const SolvedRig& solved, const std::string& recording) {
  DetectedRig detected;
  detected.rig = solved.given;
  detected.recording = recording;
  detected.mount_note = detected.stamp_at_note = "as it was";
  return rig_file_text(with_found(std::move(detected), found_rig(solved), "estimate --solve"));
}

}  // namespace sweepscope
