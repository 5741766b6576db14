#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sweepscope::ui {

/// The file of the list of recent recordings of this user; empty without a home folder.
std::filesystem::path recent_list_path();

/// The files and folders on the list that still exist, newest first. A list that cannot be read is empty.
std::vector<std::string> read_recent(const std::filesystem::path& list);

/// The list with a file or folder at its front. Write errors are ignored: the list is a convenience.
std::vector<std::string> remember_recent(const std::filesystem::path& list, std::vector<std::string> recent,
                                         const std::string& file);

}  // namespace sweepscope::ui
