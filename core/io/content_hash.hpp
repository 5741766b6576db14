#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace sweepscope {

/// 32 hexadecimal digits that identify contents (XXH3, 128 bits; not cryptographic).
std::string content_hash(std::string_view bytes);

/// The hash of a file, read in pieces, or of the files in a folder with their names, in the order of the
/// names. Fails as reading does.
Result<std::string> file_content_hash(const std::filesystem::path& path);

/// The content hash of a recording: of its file, or of all files below its folder with their names.
Result<std::string> recording_content_hash(const std::filesystem::path& path);

/// The content hash of the running program's own file. It serves as the version: another build may give other
/// results.
Result<std::string> program_content_hash();

}  // namespace sweepscope
