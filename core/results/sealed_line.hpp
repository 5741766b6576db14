#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sweepscope {

/// Files that are appended to while a command works: lines of JSON, each with the hash of its bytes, so that
/// damage is detected, in a file that is locked against a second run.

/// A JSON object as a line of such a file, with its hash and its end.
std::string sealed_line(std::string_view object);

/// Whether no byte of a line (without its end) differs from when it was written.
bool is_sound_line(std::string_view line);

/// Opens such a file, or creates it, and locks it; -1 with errno where that fails (EWOULDBLOCK: another run
/// has it). Where a file system has no locks there is none.
int open_locked(const std::filesystem::path& path);

/// Appends all bytes; false with errno where that fails.
bool write_whole(int descriptor, std::string_view bytes);

}  // namespace sweepscope
