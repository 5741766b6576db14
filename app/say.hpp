#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace sweepscope::app {

/// Words for a person, on stderr. Where that is closed or full nobody reads them: that is no failure.
template <typename... T>
void say(fmt::format_string<T...> format, T&&... values) {
  const std::string text = fmt::format(format, std::forward<T>(values)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace sweepscope::app
