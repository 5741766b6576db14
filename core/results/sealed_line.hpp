#pragma once

#include <string>
#include <string_view>

namespace sweepscope {

/// Lines of JSON, each with the hash of its bytes, so that damage is detected: what the files consist of that
/// are appended to while a command works (see sealed_file.hpp).

/// A JSON object as such a line, with its hash and its end.
std::string sealed_line(std::string_view object);

/// Whether no byte of a line (without its end) differs from when it was written.
bool is_sound_line(std::string_view line);

}  // namespace sweepscope
