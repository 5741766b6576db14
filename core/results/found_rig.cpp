#include "core/results/found_rig.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/results/rig_json.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

std::string not_determined(const RigFinding& part, const std::string& source) {
  return fmt::format("not determined by {}, unchanged: {}", source, part.reason);
}

std::string mount_note(const SolvedRig& found, const std::string& source) {
  if (!found.mount.identifiable) return not_determined(found.mount, source);
  const MountSigma sigma = mount_sigma(found);
  const Eigen::Vector3d &rpy_deg = sigma.rpy_deg, xyz_mm = sigma.xyz_m * 1e3;
  if (found.along_walk)
    return fmt::format(
        "turned as found by {}: +- {:.4f}, {:.4f}, {:.4f} deg; 0 about the motor's axis, where a turn has no "
        "effect. The shift is unchanged: {}",
        source, rpy_deg.x(), rpy_deg.y(), rpy_deg.z(), found.mount.reason);
  return fmt::format(
      "found by {}: +- {:.4f}, {:.4f}, {:.4f} deg and {:.2f}, {:.2f}, {:.2f} mm; 0 where a turn about the "
      "motor's axis or a shift along it has no effect",
      source, rpy_deg.x(), rpy_deg.y(), rpy_deg.z(), xyz_mm.x(), xyz_mm.y(), xyz_mm.z());
}

std::string gear_note(const RigFinding& part, double sigma_deg, const std::string& source) {
  if (!part.identifiable) return not_determined(part, source);
  return fmt::format("found by {}: +- {:.4f} deg", source, sigma_deg);
}

}  // namespace

Result<std::optional<SolvedRig>> parse_found_rig(std::string_view json, std::string_view name) {
  const Json document = Json::parse(json, nullptr, false);
  if (document.is_discarded()) return unreadable(fmt::format("{}: not JSON", name));
  if (!document.contains("parameters")) return std::nullopt;
  auto found = solved_rig_of(document.at("parameters"));
  if (!found) return unreadable(fmt::format("{}: the parameters of the rig cannot be read", name));
  return found;
}

DetectedRig with_found(DetectedRig detected, const SolvedRig& found, const std::string& source) {
  Rig& rig = detected.rig;
  if (found.mount.solved) detected.mount_note = mount_note(found, source);
  if (found.mount.identifiable) {
    rig.mount.laser_in_motor_rpy_deg = found.rig.mount.laser_in_motor_rpy_deg;
    rig.mount.laser_in_motor_xyz_m = found.rig.mount.laser_in_motor_xyz_m;
  }
  if (found.play.solved) detected.play_note = gear_note(found.play, play_sigma_deg(found), source);
  if (found.play.identifiable) rig.gear.play_deg = found.rig.gear.play_deg;
  if (found.encoder.solved)
    detected.encoder_note = gear_note(found.encoder, encoder_sigma_deg(found), source);
  if (found.encoder.identifiable) {
    rig.gear.encoder_amplitude_deg = found.rig.gear.encoder_amplitude_deg;
    rig.gear.encoder_phase_deg = found.rig.gear.encoder_phase_deg;
  }
  return detected;
}

std::string found_rig_file(const SolvedRig& solved, const std::string& recording) {
  DetectedRig detected;
  detected.rig = solved.given;
  detected.recording = recording;
  detected.mount_note = detected.stamp_at_note = "unchanged";
  // Through the JSON, whose digits are those of the file.
  return rig_file_text(with_found(std::move(detected), solved_rig_of(rig_parameters_json(solved)).value(),
                                  "estimate --solve"));
}

}  // namespace sweepscope
