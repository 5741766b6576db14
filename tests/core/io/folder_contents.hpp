#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "tests/core/io/test_files.hpp"

namespace sweepscope::test {

/// Every name in a folder with what is in it; empty for what is no regular file.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files[entry.path().filename().string()] =
        entry.is_regular_file() && !entry.is_symlink() ? contents_of(entry.path()) : "";
  return files;
}

}  // namespace sweepscope::test
