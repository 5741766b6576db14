#pragma once

#include <filesystem>
#include <optional>

#include "core/apply/provenance.hpp"
#include "core/error.hpp"

namespace sweepscope::app {

/// The offset of --estimate or, without it, of --offset-ms, which must be there then.
Result<AppliedOffset> applied_offset(const std::optional<std::filesystem::path>& estimate,
                                     const std::optional<double>& offset_ms);

}  // namespace sweepscope::app
