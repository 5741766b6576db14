#pragma once

#include <string>

namespace sweepscope {

/// The text with U+FFFD for what is not UTF-8, as in names of files.
std::string valid_utf8(const std::string& text);

}  // namespace sweepscope
