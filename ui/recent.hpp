#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sweepscope::ui {

/// Where the list of recent recordings is kept for this user; empty where there is no home.
std::filesystem::path recent_list_path();

/// The files and folders on the list that still exist, newest first. A list that cannot be read is empty.
std::vector<std::string> read_recent(const std::filesystem::path& list);

/// The list with a file or folder at its front. What cannot be written is let go: the list is a convenience.
std::vector<std::string> remember_recent(const std::filesystem::path& list, std::vector<std::string> recent,
                                         const std::string& file);

}  // namespace sweepscope::ui
