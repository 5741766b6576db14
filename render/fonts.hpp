#pragma once

#include <string>

namespace sweepscope {

/// A path from which the font (DejaVu Sans) can be read for as long as the program runs. The fonts are inside
/// the program, so that it draws the same text wherever it is.
const std::string& font_path(bool bold);

}  // namespace sweepscope
