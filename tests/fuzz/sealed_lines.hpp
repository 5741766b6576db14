#pragma once

#include <string>
#include <string_view>

#include "core/results/sealed_line.hpp"

namespace sweepscope::test {

/// Each line with the hash of its text, as the files of rows and candidates have it.
inline std::string sealed_lines(std::string_view text) {
  std::string whole;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1)
    whole += end > begin ? sealed_line(text.substr(begin, end - begin)) : "\n";
  return whole.append(text.substr(begin));
}

}  // namespace sweepscope::test
