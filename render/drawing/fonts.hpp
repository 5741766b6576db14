#pragma once

#include <string>
#include <string_view>

namespace sweepscope {

/// A path from which the font (DejaVu Sans) can be read for as long as the program runs. The fonts are
/// embedded in the program, so that it draws the same text on every machine.
const std::string& font_path(bool bold);

/// The same as bytes.
std::string_view font_bytes(bool bold);

}  // namespace sweepscope
