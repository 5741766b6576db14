#pragma once

#include <string>

#include "core/error.hpp"

namespace sweepscope {

/// The content hash of the running program's own file. It stands for the version: another build may answer
/// otherwise.
Result<std::string> program_content_hash();

}  // namespace sweepscope
