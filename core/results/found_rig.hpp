#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/recording/rig/detect_rig.hpp"
#include "core/rig_solve/rig_solve.hpp"

namespace sweepscope {

/// The rig that an estimate solved for, from its JSON; absent in one that solved for nothing. An invalid
/// document is ExitCode::kUnreadableInput with a sentence that begins with `name`.
Result<std::optional<SolvedRig>> parse_found_rig(std::string_view json, std::string_view name);

/// The rig with the parts that were found. Its notes say that they were found by `source`, such as
/// "estimate --solve", with their standard deviations; or that they were not determined, and why.
DetectedRig with_found(DetectedRig detected, const SolvedRig& found, const std::string& source);

/// The rig file of a rig that was solved for from a recording of this name.
std::string found_rig_file(const SolvedRig& solved, const std::string& recording);

}  // namespace sweepscope
