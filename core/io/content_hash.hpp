#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

/// 32 hexadecimal digits that tell contents apart (XXH3, 128 bits; not against forgery).
std::string content_hash(std::string_view bytes);

/// Of a file, read in pieces, or of the files in a folder and their names, in the order of these. Fails as
/// reading does.
Result<std::string> file_content_hash(const std::filesystem::path& path);

/// The content hash of a recording: of its file, or of all files below its folder with their names.
Result<std::string> recording_content_hash(const std::filesystem::path& path);

/// The content hash of the running program's own file. It stands for the version: another build may answer
/// otherwise.
Result<std::string> program_content_hash();

}  // namespace sweepscope
