#pragma once

#include <string_view>

namespace sweepscope::ui {

/// A file of assets/serve, embedded in the program.
struct ServedFile {
  std::string_view path;  // such as "/main.js"
  std::string_view type;
  std::string_view text;
};

/// Null if there is none; "/" is the page.
const ServedFile* find_served_file(std::string_view path);

}  // namespace sweepscope::ui
