#pragma once

#include <filesystem>

namespace sweepscope {

/// Remembers files that are being written beside their places, each until it is forgotten.
void remember_unfinished(const std::filesystem::path& path);
void forget_unfinished(const std::filesystem::path& path);

/// Removes those that are remembered: for a program that ends without coming back to their writers.
void remove_unfinished_files();

}  // namespace sweepscope
