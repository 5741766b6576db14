#pragma once

#include <string>

namespace sweepscope {

/// A word as a shell takes it: in 'single quotes' unless all of it is plain.
std::string shell_word(const std::string& word);

}  // namespace sweepscope
