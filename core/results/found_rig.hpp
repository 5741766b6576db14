#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/recording/rig/detect_rig.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// The parts of a rig that an estimate solved for: "parameters" of its JSON. Absent: not solved for.
struct FoundRig {
  struct Part {
    bool identifiable = false;
    std::string reason;  // why not
  };
  struct Mount : Part {
    Eigen::Vector3d rpy_deg{0, 0, 0}, xyz_m{0, 0, 0};
    Eigen::Vector3d sigma_rpy_deg{0, 0, 0}, sigma_xyz_m{0, 0, 0};
    bool shift_identifiable = true;  // not from a walk
  };
  struct Play : Part {
    double value_deg = 0, sigma_deg = 0;
  };
  struct Encoder : Part {
    double amplitude_deg = 0, phase_deg = 0, sigma_deg = 0;
  };
  std::optional<Mount> mount;
  std::optional<Play> play;
  std::optional<Encoder> encoder;

  bool any() const { return mount || play || encoder; }
};

FoundRig found_rig(const SolvedRig& solved);

/// What the JSON of an estimate says; empty of one that solved for nothing. An invalid document is
/// ExitCode::kUnreadableInput with a sentence that begins with `name`.
Result<FoundRig> parse_found_rig(std::string_view json, std::string_view name);

/// The rig with the parts that were found. Its notes say that they were found by `source`, such as
/// "estimate --solve", with their standard deviations; or that they were not determined, and why.
DetectedRig with_found(DetectedRig detected, const FoundRig& found, const std::string& source);

/// The rig file of a rig that was solved for from a recording of this name.
std::string found_rig_file(const SolvedRig& solved, const std::string& recording);

}  // namespace sweepscope
