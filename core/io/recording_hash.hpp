#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace sweepscope {

/// The content hash of a recording: of its file, or of all files below its folder with their names.
Result<std::string> recording_content_hash(const std::filesystem::path& path);

}  // namespace sweepscope
