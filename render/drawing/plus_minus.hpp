#pragma once

#include <string>

namespace sweepscope {

/// A sentence of the engine as a picture or a page shows it: with ± where the command line writes +-.
inline std::string with_plus_minus_sign(std::string sentence) {
  for (auto at = sentence.find("+- "); at != sentence.npos; at = sentence.find("+- ", at))
    sentence.replace(at, 2, "±");
  return sentence;
}

}  // namespace sweepscope
